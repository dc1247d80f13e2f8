// Views of charts as figures write them: axes, rows drawn as marks, and how marks look.
{
  const dashes = [[], [7, 4], [2, 3], [9, 3, 2, 3], [14, 5], [9, 3, 2, 3, 2, 3]];
  const symbols = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow"];
  // Of curve k: each symbol comes with each dash before a pair comes again.
  const symbolOf = (k) => symbols[k % symbols.length];
  const dashOf = (k) => dashes[(k + Math.floor(k / symbols.length)) % dashes.length];

  // A view of quantities x and y over one frame. `along`: hovering reads all curves at one x.
  const view = (x, y, xAxis, yAxis, along = false) => ({
    x,
    y,
    along,
    notes: [],
    frames: [{left: 72, right: 18, top: 14, bottom: 46}],
    xAxes: [].concat(xAxis),
    yAxes: [].concat(yAxis),
    marks: []
  });
  // Draws rows: `encode` names the columns along x and y, `look` is a mark. A row's `text`, where it has one, is what
  // hovering says of it. `only` {column: value} picks some of the rows, and draws nothing where there are none.
  function draw({marks}, rows, {x, y}, look, only) {
    const some = only ? rows.filter((row) => Object.entries(only).every(([name, value]) => row[name] === value)) : rows;
    if (!only || some.length) marks.push({mark: "line", ...look, rows: some, x, y});
  }
  // Two rows per row, at the two ends of a bar, and one that ends the line between them.
  const ends = (rows, low, high) => rows.flatMap((row) => [row[low], row[high], null].map((end) => ({...row, end})));

  // A view of named rows, the first on top; `along` is the horizontal axis, `height` that of a row.
  function namedRows(names, x, along, height = 26) {
    const most = window.innerWidth < 600 ? 130 : 250, letter = 13, frame = 64,
          width = Math.min(most, 14 + Math.max(0, ...names.map((name) => ricochet.widthOf(name)))),
          lines = Math.max(1, ...names.map((name) => ricochet.linesOf(name, width - 12).length));
    const out = view(x, ["", "1"], along, {type: "category", data: names});
    Object.assign(out.frames[0], {left: width + 4, right: 24});
    return Object.assign(out, {height: frame + Math.max(height, letter * lines + 6) * names.length});
  }
  // Labels of cases for so many rows at most: by all columns given, else by the scheme with its parameters, else by its
  // name.
  const rowLabels = (view, cases, columns, rows) => {
    const schemes = view.varying.filter((column) => ricochet.roleOf(column) === "time");
    const tried = [columns, schemes, ["time"]].find((some) => view.group(cases, some).length <= rows) || [];
    return (one) =>
               ricochet.shorten(view.label(one, tried) || (tried.length ? ricochet.textOf(one, "time") : "all cases"));
  };

  // A line with marks on its points.
  const curve = ({name, colour, style}, size = 8, width = 1.6) =>
      ({mark: "line", name, colour, symbol: symbolOf(style), size, width, dash: dashOf(style)});
  // The same with hollow marks where a row says so.
  const hollowCurve = (one, rows, size, width) =>
      ({...curve(one, size, width), ...(rows.some((row) => row.hollow) ? {hollow: (row) => row.hollow} : {})});
  // A line without marks.
  const line = (name, colour, width, dash = []) => ({mark: "line", name, z: 1, colour, width, dash});
  const dot = (name, colour, symbol, size, z = 3) => ({mark: "dots", name, symbol, size, colour, z});
  // A hollow one, which another fits into.
  const ring = (name, colour, size) => ({...dot(name, colour, "circle", size), hollow: true});
  const rule = (name, at, said, more) => ({mark: "rule", name, at, said, silent: true, z: 5, ...more});

  // Marks of text, which the legend filters with the curve of their name, on an axis of their own.
  function drawMarks({marks}, {name, colour}, rows, more) {
    if (rows.length)
      marks.push({mark: "words", name, colour, rows, x: "at", y: "height", z: 5, yAxis: 1, apart: false, ...more});
  }
  // The mark of a case without a value at a place.
  const outcome = (one, at) =>
      ({case: one.id, at, mark: ricochet.format.mark(one.status), text: one.status + ": " + one.reason});
  // The grey of a strip for what has no value.
  const strip = (name, yAxis) =>
      ({mark: "cells", name, colour: "#f2f2f2", silent: true, z: 0, yAxis, rows: [{}], x: [null, null]});
  // Marks [curve, rows] of what has no value, in a grey strip of their own above the frame: those of one place are
  // stacked. The strip is wider than the axis, so that marks at its ends are whole.
  function outcomeStrip(view, marks, word = "no value") {
    const stacked = new Map(), [frame] = view.frames, pad = 10;
    const placed = marks.map(([curve, rows]) => [curve, rows.map((row) => {
                               const height = stacked.get(row.at) || 0;
                               stacked.set(row.at, height + 1);
                               return {...row, height};
                             })]);
    const lanes = Math.max(0, ...stacked.values()), height = Math.min(18 * lanes, 84);
    if (!lanes) return;
    const yAxis = view.yAxes.push({
      type: "category",
      frame: view.frames.push({...frame, height, pad}) - 1,
      data: [word, ...Array(lanes - 1).fill("")]
    }) - 1;
    frame.top += height + 8;
    view.xAxes.push({...view.xAxes[0], bare: true, plain: true});
    view.marks.push(strip(word, yAxis));
    for (const [curve, rows] of placed) drawMarks(view, curve, rows, {yAxis});
  }
  // The pale line of a fitted order, with the order at its end.
  function fitted(view, rows, encode, {name, colour}, order) {
    view.frames[0].right = 86;  // for the order
    draw(view, rows, encode, {
      ...line(name, ricochet.lighten(colour, 0.72), 7),
      cap: "round",
      end: ricochet.format.order(order),
      endColour: colour
    });
  }

  // Colour mixed with white: share 0 keeps it, 1 is white.
  const lighten = (colour, share) => "#" +
      [1, 3, 5]
          .map((k) => {
            const value = parseInt(colour.slice(k, k + 2), 16);
            return Math.round(value + share * (255 - value)).toString(16).padStart(2, "0").toUpperCase();
          })
          .join("");
  const slug = (column) => column.replace(/\./g, "-");
  // The names of the marks in some charts.
  const drawnNames = (charts) =>
      new Set(charts.flatMap(({views}) => views.flatMap(({marks}) => marks.map(({name}) => name))));
  // An entry of a legend without a line; entries of which the first of each name and view stays.
  const swatch = (name, colour, symbol = "rect", heading) => ({name, colour, dash: "0 30", symbol, heading});
  const firstOfName = (entries) => entries.filter(
      ({name, only}, k) => entries.findIndex((other) => other.name === name && other.only === only) === k);

  Object.assign(ricochet, {
    view,
    draw,
    ends,
    namedRows,
    rowLabels,
    curve,
    hollowCurve,
    line,
    dot,
    ring,
    rule,
    drawMarks,
    outcome,
    strip,
    outcomeStrip,
    fitted,
    lighten,
    slug,
    drawnNames,
    swatch,
    firstOfName,
    unseenZeros: "Exactly 0, which a logarithmic axis cannot show: ",
    ownScale: "This chart has its own scale: its values are over 4 times those of most others.",
    dash: dashOf,
    svgDash: (k) => dashOf(k).join(" "),
    symbol: symbolOf,
  });
}
