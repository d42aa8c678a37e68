// For the keyboard: what scrolls sideways can be reached, and headings of the contents say their level.
function reachable() {
  for (const it of document.querySelectorAll("pre, div.math, .table-wrapper, div.output")) {
    if (it.scrollWidth > it.clientWidth) it.tabIndex = 0;
    else if (it.tabIndex === 0) it.removeAttribute("tabindex");
  }
}
for (const it of document.querySelectorAll('[role="heading"]:not([aria-level])')) it.setAttribute("aria-level", "2");
reachable();
addEventListener("load", reachable);
addEventListener("resize", reachable);
