// A chart as a picture file, with title and legend; and its drawing as SVG for paper.
{
  const line = 20;

  // Rows of the legend that fit a width: [{entry, x, y}], and how tall they are.
  function legendRows(entries, width) {
    let x = 12, y = 0;
    const rows = entries.map((entry) => {
      const wide = 58 + ricochet.widthOf(entry.name);
      if (x > 12 && x + wide > width) [x, y] = [12, y + line];
      const out = {entry, x, y};
      x += wide;
      return out;
    });
    return {rows, height: entries.length ? y + line : 0};
  }
  function drawLegend(pen, rows, top) {
    for (const {entry: {name, colour, dash, symbol, hollow}, x, y} of rows) {
      const middle = top + y + 8, shape = ricochet.plot.shapes[symbol];
      if (dash !== "0 30")
        pen.path(
            "M" + x + " " + middle + "h30", {stroke: colour, width: 2, dash: dash ? dash.split(" ").map(Number) : []});
      if (shape)
        pen.stamps(
            shape(4), [x + 15, middle], hollow || symbol === "cross" ? {stroke: colour, width: 1.6} : {fill: colour});
      pen.text(name, x + 36, middle);
    }
  }

  // How large a chart's picture is, and what draws it.
  function drawingOf(figure, slot) {
    const view = figure.viewOf(slot), chart = figure.chartOf(slot), {hidden, description: {title, legend}} = figure;
    // What the legend shows of what is drawn.
    const drawn = new Set(view.marks.flatMap((mark) => [mark.name, ...(mark.tags || [])])),
          entries = legend.filter(
              (entry) => drawn.has(entry.name) && !hidden.has(entry.name) && ricochet.inView(entry, figure.view)),
          {rows, height} = legendRows(entries, 900), top = 32 + height,
          size = {width: 900, height: chart.height || 440};
    return [
      {width: size.width, height: size.height + top},
      (pen) => {
        pen.rect(0, 0, size.width, size.height + top, {fill: "#ffffff"});
        pen.text(chart.title === "all cases" ? title : title + ": " + chart.title, 12, 16, {size: 14});
        drawLegend(pen, rows, 30);
        new ricochet.Plot(view, {...size, top}, {hidden, windows: figure.windows(slot)}).draw(pen);
      }
    ];
  }
  // A chart as the text of an SVG file; and as a file of either format.
  ricochet.pictureText = (figure, slot) => svgFile(svg(...drawingOf(figure, slot)));
  ricochet.picture = (figure, slot, format) => {
    if (!figure.viewOf(slot)) return null;
    return format === "svg" ? new Blob([ricochet.pictureText(figure, slot)], {type: "image/svg+xml"}) :
                              png(...drawingOf(figure, slot));
  };
  function svg(size, draw) {
    const pen = new ricochet.SvgPen(size);
    draw(pen);
    return pen.svg;
  }
  function png({width, height}, draw) {
    const fine = 3,
          canvas = Object.assign(document.createElement("canvas"), {width: fine * width, height: fine * height}),
          context = canvas.getContext("2d");
    context.scale(fine, fine);
    draw(new ricochet.CanvasPen(context));
    const url = canvas.toDataURL("image/png"), binary = atob(url.slice(url.indexOf(",") + 1));
    return new Blob([Uint8Array.from(binary, (c) => c.charCodeAt(0))], {type: "image/png"});
  }
  // SVG of this page as a file: with its name space.
  const svgFile = (text) => {
    const place = document.createElement("template");
    place.innerHTML = text;
    return new XMLSerializer().serializeToString(place.content.firstElementChild);
  };
  // The drawing of a view, as SVG; of a figure, what is shown of it.
  ricochet.drawing = (view, size, shown) => svg(size, (pen) => {
    pen.rect(0, 0, size.width, size.height, {fill: "#ffffff"});
    new ricochet.Plot(view, size, shown).draw(pen);
  });
}
