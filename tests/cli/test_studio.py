"""The command ``tpss studio``: it prints an address of this computer, and answers there."""

import json
import os
import re
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def studio(folder, *arguments) -> Iterator[str]:
    """Run the command, and give the address that it prints."""
    command = [sys.executable, "-m", "tpss", "studio", *arguments, "--no-browser"]
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, text=True, env=dict(os.environ)
    ) as server:
        assert server.stdout is not None
        try:
            for line in server.stdout:
                if found := re.search(r"http://\S+", line):
                    yield found[0]
                    break
        finally:
            server.kill()


def test_a_new_scenario_is_written_and_opened(tmp_path):
    with studio(tmp_path, "my-line", "--new") as home:
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{32}/", home)
        request = urllib.request.Request(f"{home}api/opened", data=b"{}", method="POST")
        with urllib.request.urlopen(request) as answer:
            told = json.load(answer)
        assert told["name"] == "scenario.toml"
        assert told["document"]["name"] == "first-line"
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(home.rpartition("/")[0][:-4] + "/")
    assert (tmp_path / "my-line" / "scenario.toml").is_file()


def test_a_folder_that_has_one_already_is_not_written(tpss_command, tmp_path):
    assert tpss_command("new", "my-line").code == 0
    said = tpss_command("studio", "my-line", "--new", "--no-browser")
    assert said.code == 2
    assert "exists already" in said.err


def test_a_file_that_there_is_not_is_told(tpss_command):
    said = tpss_command("studio", "no-such.toml", "--no-browser")
    assert said.code == 2
    assert "no-such.toml" in said.err


def test_a_port_that_is_taken_is_told(tpss_command):
    assert tpss_command("new", "my-line").code == 0
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        said = tpss_command("studio", "my-line/scenario.toml", "--no-browser", "--port", port)
    assert said.code == 2
    assert f"port {port} is taken" in said.err
