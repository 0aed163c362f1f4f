// What those who hear a page, or use it by keyboard, miss in the theme.

function amend() {
  // A button that copies a block of code stands in an element for navigation, which would be a landmark each.
  for (const buttons of document.querySelectorAll("nav.md-code__nav")) {
    buttons.setAttribute("role", "none");
  }
  // A table that is wider than the page is scrolled by the arrow keys once it can be reached.
  for (const table of document.querySelectorAll(".md-typeset__scrollwrap")) {
    table.tabIndex = table.scrollWidth > table.clientWidth ? 0 : -1;
  }
}

new MutationObserver(amend).observe(document.documentElement, { childList: true, subtree: true });
window.addEventListener("resize", amend);
