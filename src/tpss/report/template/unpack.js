"use strict";
// The script of the plots lies packed in the page, at a third of its size; the page's own waits for it.
async function unpack(id) {
  if (typeof DecompressionStream === "undefined") {
    for (const div of document.querySelectorAll(".plot"))
      div.textContent = "This browser is too old for the plots (2023 or later is asked for); all tables are there.";
    throw new Error("no DecompressionStream");
  }
  const bytes = Uint8Array.from(
    atob(document.getElementById(id).textContent), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(stream).text();
  document.head.append(script);
}
