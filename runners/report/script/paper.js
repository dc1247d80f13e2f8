// Paper: while the page is printed, each chart stands there once more as a drawing as wide as its place on the sheet, in the colours of paper. The summary
// takes the first chart of the page.
{
  const sheet = 680, gap = 12;   // CSS pixels between the margins of A4
  const place = (classes) => Object.assign(document.createElement("div"), { className: classes });

  function drawn(figure, slot, width, height) {
    const option = figure.option(slot);
    if (!option) return null;
    delete option.toolbox;
    if (figure.zoom) Object.assign(option.dataZoom[0], { startValue: figure.zoom.startValue, endValue: figure.zoom.endValue });
    const out = place("on-paper");
    out.innerHTML = ricochet.drawing(option, { width, height });
    return out;
  }
  // As many charts side by side as the style of paper has columns.
  function sizeOf(figure, slot) {
    const grid = slot.element.closest(".grid"), whole = grid.matches(".single, .stacked") || slot.element.closest("figure").matches(".wide"), given = figure.chartOf(slot).height;
    return { width: whole ? sheet : (sheet - gap) / 2, height: given ? (whole ? given : Math.min(given, 300)) : whole ? 300 : 215 };
  }
  function prepare() {
    finish();
    for (const figure of ricochet.figures)
      for (const slot of figure.slots) {
        if (!figure.visible(slot) || slot.element.closest("figure").hidden) continue;
        const { width, height } = sizeOf(figure, slot), drawing = drawn(figure, slot, width, height);
        if (drawing) slot.element.after(drawing);
      }
    const summary = document.getElementById("summary-figure");
    if (summary) showFirst(summary);
  }
  function finish() { document.querySelectorAll(".on-paper").forEach((one) => one.remove()); }

  function showFirst(place) {
    const figure = ricochet.figures.find((one) => one.slots.some((slot) => one.visible(slot) && one.viewOf(slot).option));
    if (!figure || place.childElementCount) return;
    const slot = figure.slots.find((one) => figure.visible(one) && figure.viewOf(one).option), given = figure.chartOf(slot).height, drawing = drawn(figure, slot, sheet, given ? Math.min(given, 330) : 230);
    drawing.className = "drawing";
    const caption = document.createElement("figcaption"), legend = figure.section.querySelector(".legend");
    caption.textContent = figure.description.title + (figure.description.charts.length > 1 ? ": " + figure.chartOf(slot).title : "");
    place.append(caption, ...(legend ? [legend.cloneNode(true)] : []), drawing);
  }

  ricochet.paper = { prepare, finish, showFirst };
}
