"""Nothing is answered but to the studio's own page at its address."""

import pytest

from studio_page import HOME, TOKEN


def test_the_page_is_at_the_address_with_the_token(page):
    answer = page.client.get(f"/{TOKEN}/")
    assert answer.status_code == 200
    assert "TPSS studio" in answer.text


@pytest.mark.parametrize(
    "path", ["/", "/api/opened", "/another-secret/", f"/{TOKEN}x/", f"/{TOKEN}"]
)
def test_without_the_token_nothing_is_answered(page, path):
    answer = page.client.get(path, follow_redirects=False)
    assert answer.status_code == 404
    assert "TPSS" not in answer.text


@pytest.mark.parametrize("host", ["railway.example", "127.0.0.1.railway.example", "[::1]:8000"])
def test_another_name_of_the_server_is_refused(page, host):
    assert page.client.get(f"/{TOKEN}/", headers={"Host": host}).status_code == 421


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://railway.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:9999"},
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
    ],
)
def test_other_pages_are_refused(page, headers):
    answer = page.client.post(f"/{TOKEN}/api/opened", json={}, headers=headers)
    assert answer.status_code == 403


def test_its_own_page_is_answered(page):
    headers = {"Origin": HOME, "Sec-Fetch-Site": "same-origin"}
    assert page.client.post(f"/{TOKEN}/api/opened", json={}, headers=headers).status_code == 200


def test_long_bodies_are_refused(page):
    answer = page.client.post(f"/{TOKEN}/api/opened", content=b" " * 4_000_001)
    assert answer.status_code == 413


@pytest.mark.parametrize("path", ["/", "/api/ready", "/main.js", "/no-such-file"])
def test_every_answer_forbids_all_that_is_not_its_own(page, path):
    headers = page.client.get(f"/{TOKEN}{path}").headers
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert "unsafe" not in headers["Content-Security-Policy"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"


@pytest.mark.parametrize("path", ["/../app.py", "/%2e%2e/app.py", "/vendor/../../app.py"])
def test_no_path_leaves_the_page(page, path):
    assert page.client.get(f"/{TOKEN}{path}").status_code in (403, 404)


@pytest.mark.parametrize("body", [b"[]", b"{", b'{"edits": 3}', b'{"edits": [["a"]]}', b"\xff"])
def test_what_is_not_understood_is_refused(page, body):
    answer = page.client.post(f"/{TOKEN}/api/changes", content=body)
    assert answer.status_code == 400
    assert "not understood" in answer.json()["refused"]
