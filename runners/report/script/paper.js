// Paper. While the page is printed, each chart stands there once more as a drawing. It is as wide as its place on the
// sheet, and has the colours of paper. The summary takes the first chart of the page.
{
  const sheet = 680, tall = 985, gap = 12;  // CSS pixels between the margins of A4
  const place = (classes) => Object.assign(document.createElement("div"), {className: classes});

  function drawn(figure, slot, width, height) {
    const view = figure.viewOf(slot);
    if (!view) return null;
    const out = place("on-paper");
    out.innerHTML = ricochet.drawing(view, {width, height}, {hidden: figure.hidden, windows: figure.windows(slot)});
    return out;
  }
  // As many charts side by side as the style of paper has columns.
  function sizeOf(figure, slot) {
    const grid = slot.element.closest(".grid"),
          whole = grid.matches(".single, .stacked") || slot.element.closest("figure").matches(".wide"),
          given = figure.chartOf(slot).height;
    return {
      width: whole ? sheet : (sheet - gap) / 2,
      height: given ? (whole ? given : Math.min(given, 300)) :
          whole     ? 300 :
                      215
    };
  }
  function prepare() {
    finish();
    for (const figure of ricochet.figures)
      for (const slot of figure.slots) {
        if (!figure.visible(slot) || slot.element.closest("figure").hidden) continue;
        const {width, height} = sizeOf(figure, slot), drawing = drawn(figure, slot, width, height);
        if (drawing) slot.element.after(drawing);
      }
    const figure = document.getElementById("summary-figure");
    if (figure) {
      showFirst(figure);
      fit(document.getElementById("summary"));
    }
  }
  function finish() {
    document.querySelectorAll(".on-paper").forEach((one) => one.remove());
    const summary = document.getElementById("summary");
    if (summary) {
      summary.className = "sheet";
      summary.style.removeProperty("--fit");
    }
  }

  // The largest letters, in points, at which the summary stays on one sheet, tried on a copy beside the page. Where
  // even small ones do not do, the figure gets smaller and the legend goes, which the report has. The answer's lesser
  // lines go next.
  function fit(summary) {
    const probe = place("sheet-probe"), copy = summary.cloneNode(true);
    copy.querySelectorAll("[id]").forEach((part) => part.removeAttribute("id"));
    copy.querySelectorAll(".on-screen").forEach((part) => part.remove());
    copy.removeAttribute("id");
    probe.append(copy);
    document.body.append(probe);
    const tries = ["", "lean", "brief lean", "brief briefer lean"].flatMap(
        (classes) => [10, 9.5, 9, 8.5, 8, 7.5, 7, 6.5].map((size) => [classes, size]));
    const found = tries.find(([classes, size]) => {
      copy.className = "sheet " + classes;
      copy.style.setProperty("--fit", size + "pt");
      return copy.offsetHeight <= tall;
    }) ||
        tries[tries.length - 1];
    probe.remove();
    summary.className = "sheet " + found[0];
    summary.style.setProperty("--fit", found[1] + "pt");
  }

  function showFirst(place) {
    // The figure that stands beside the answer, where there is one.
    const usable = ricochet.figures.filter((one) => one.slots.some((slot) => one.visible(slot) && one.viewOf(slot))),
          figure = usable.find((one) => one.section.closest("#answer")) || usable[0];
    if (!figure || place.childElementCount) return;
    const slot = figure.slots.find((one) => figure.visible(one) && figure.viewOf(one)),
          given = figure.chartOf(slot).height, drawing = drawn(figure, slot, sheet, given ? Math.min(given, 330) : 230);
    drawing.className = "drawing";
    const caption = document.createElement("figcaption"), legend = figure.section.querySelector(".legend");
    caption.textContent =
        figure.description.title + (figure.description.charts.length > 1 ? ": " + figure.chartOf(slot).title : "");
    place.append(caption, ...(legend ? [legend.cloneNode(true)] : []), drawing);
  }

  ricochet.paper = {prepare, finish, showFirst};
}
