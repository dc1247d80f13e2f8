// What the charts of a figure hold, and what was painted.
(() => {
  "use strict";
  const all = (selector, from) => Array.from((from || document).querySelectorAll(selector));
  const mostItems = 3000;  // of a mark that are read back one by one

  // Pixels with a hue: grey is axes and text.
  function coloured({element}) {
    const canvas = element.querySelector("canvas");
    if (!canvas || !canvas.width || !canvas.height) return 0;
    const copy = Object.assign(document.createElement("canvas"), {width: canvas.width, height: canvas.height}),
          context = copy.getContext("2d", {willReadFrequently: true});
    context.drawImage(canvas, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 0 &&
          Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 24)
        ++count;
    return count;
  }
  // Pairs of words of a chart that lie on each other, as its pen wrote them. Single letters may: where they stand says
  // something.
  function collisions({plot}) {
    const boxes = plot.pen.words.filter(([words]) => words.trim().length > 1), out = [];
    boxes.forEach(([name, left, top, right, bottom], k) => {
      for (const [other, low, high, far, deep] of boxes.slice(k + 1))
        if (left + 1 < far - 1 && low + 1 < right - 1 && top + 1 < deep - 1 && high + 1 < bottom - 1)
          out.push(name + " | " + other);
    });
    return out;
  }
  // Words of a chart that pass its edge.
  const beyond = ({plot}) => plot.pen.words
                                 .filter(
                                     ([, left, top, right, bottom]) =>
                                         left < -1 || top < -1 || right > plot.width + 1 || bottom > plot.height + 1)
                                 .map(([words]) => words);

  const pick = (from, names) => Object.fromEntries(
      names.filter((name) => from[name] !== undefined && from[name] !== null).map((name) => [name, from[name]]));
  const ofPlainRow = (setting) => (typeof setting === "function" ? setting({}) : setting);
  // A point: where it lies, the words of its row, and where it looks unlike a row with nothing to tell.
  function itemOf(mark, i, x, y, plain) {
    const row = ricochet.plot.rowAt(mark, i), out = {value: [x(i), y(i)], ...pick(row, ["text", "mark"])};
    for (const name of ["colour", "size", "hollow"])
      if (typeof mark[name] === "function" && Boolean(mark[name](row)) && mark[name](row) !== plain[name])
        out[name] = mark[name](row);
    return out;
  }
  function markOf(mark, plot) {
    const {
      countOf,
      reader
    } = ricochet.plot,
    out = pick(
        mark,
        [
          "mark", "name", "tags", "symbol", "width", "dash", "yAxis", "z", "end", "at", "said", "silent", "what", "id",
          "group"
        ]),
    plain = {colour: ofPlainRow(mark.colour), size: ofPlainRow(mark.size), hollow: ofPlainRow(mark.hollow)};
    Object.assign(out, plain);
    out.given = countOf(mark);
    out.count = plot.counts.get(mark) ?? out.given;
    if (mark.values) return mark.what === "points" ? out : {...out, values: mark.values};
    if (mark.mark === "image") return {...out, x: mark.x, y: mark.y};
    const x = Array.isArray(mark.x) ? () => null : reader(mark, "x"),
          y = Array.isArray(mark.y) ? () => null : reader(mark, "y");
    out.data = out.given <= mostItems ? Array.from({length: out.given}, (_, i) => itemOf(mark, i, x, y, plain)) : [];
    return out;
  }
  // Marks of a chart, whether its legend shows them or not.
  const marksIn = ({view, plot}) => view.marks.map((mark) => markOf(mark, plot));
  function readBack(figure, slot) {
    const view = figure.viewOf(slot), out = {coloured: 0, notes: [], series: [], sources: []};
    if (!slot.chart || !view) return out;
    const {plot} = slot.chart,
          axis = ({axis: one}) => pick(one, ["name", "type", "min", "max", "frame", "data", "hidden"]);
    out.coloured = coloured(slot);
    out.xAxis = plot.xs.map(axis);
    out.yAxis = plot.ys.map(axis);
    out.frames = plot.frames;
    out.series = marksIn(slot.chart).filter((mark) => !mark.what);
    out.sources = marksIn(slot.chart).filter((mark) => mark.what);
    out.collisions = collisions(slot.chart);
    out.beyond = beyond(slot.chart);
    return out;
  }
  const notesIn = (figure, index, view) => all("figure", figure.section)[index] ?
      all(":scope > ul.notes li, :scope > div[data-notes]:not([hidden]) li", all("figure", figure.section)[index])
          .map((li) => li.textContent) :
      [];

  window.readback = {all, coloured, pick, marksIn, readBack, notesIn};
})();
