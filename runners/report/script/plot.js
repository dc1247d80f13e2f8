// A view of a chart, drawn: frames, axes and marks on a pen, and what lies where.
//
// A view is {x, y, notes, frames, xAxes, yAxes, along, marks, words, open}. `x` and `y` are quantities. `frames` are
// {left, top} with {right, bottom} or {width, height}, an axis along x each; `pad`: what it is wider than that axis.
// `along`: hovering reads all curves at one x. `words` says what lies at a place, `open` shows it; both take what `at`
// gives.
//
// A mark is {mark, name, tags, colour, z, yAxis, silent, case} and what it draws. It has rows (objects), columns by
// name or a function that gives these, and `x`, `y` name columns; or `values`, packed pairs (x, y), where there are
// many.
//   line     width, dash, cap, symbol, size, area (its opacity), end (words behind its end), thin (least and largest of
//            a pixel alone)
//   dots     symbol, size, hollow, edge, opacity, shift (pixels)
//   words    `said` of a row in bold
//   whiskers values are triples (x, low, high)
//   bars     along x; thick (pixels or a share), stack, said
//   cells    x, y: [from, to], each a column, a number or null, which is the frame's edge; or y a place of a category
//   rule     at: {x} or {y}, a number; said; dash
//   image    x, y: [from, to]; picture(colour) gives a canvas
// colour, size and hollow may be functions of a row.
{
  const ink = "#333333", faint = "#9a9a9a", pale = "#ececec", letter = 12, roundness = 0.5523;
  const dotsWhole = 4000;  // points of a line up to which each is drawn

  const polygon = (...points) => (r) => "M" + points.map(([x, y]) => n(r * x) + " " + n(r * y)).join("L") + "Z";
  const n = (value) => Math.round(100 * value) / 100;
  const circle = (r) => "M" + n(-r) + " 0A" + n(r) + " " + n(r) + " 0 1 1 " + n(r) + " 0A" + n(r) + " " + n(r) +
      " 0 1 1 " + n(-r) + " 0Z";
  const rect = polygon([-1, -1], [1, -1], [1, 1], [-1, 1]), triangle = polygon([0, -1], [1, 1], [-1, 1]);
  // Shapes of radius r around their place.
  const shapes = {
    circle,
    rect,
    triangle,
    diamond: polygon([0, -1], [1, 0], [0, 1], [-1, 0]),
    roundRect: polygon([-0.5, -1], [0.5, -1], [1, -0.5], [1, 0.5], [0.5, 1], [-0.5, 1], [-1, 0.5], [-1, -0.5]),
    arrow: polygon([0, -1], [1, 1], [0, 0.5], [-1, 1]),
    "triangle-down": polygon([0, 1], [1, -1], [-1, -1]),
    "triangle-right": polygon([1, 0], [-1, 1], [-1, -1]),
    cross: (r) =>
        "M" + n(-r) + " " + n(-r) + "L" + n(r) + " " + n(r) + "M" + n(r) + " " + n(-r) + "L" + n(-r) + " " + n(r),
    tick: (r) => "M-1 " + n(-r) + "h2V" + n(r) + "h-2Z",
    bar: (r) => "M" + n(-r) + " -0.6H" + n(r) + "V0.6H" + n(-r) + "Z",
  };

  const columnsOf = new WeakMap();
  // What a mark draws; columns that are worked out are so once.
  function rowsOf(mark) {
    if (typeof mark.rows !== "function") return mark.rows || [];
    if (!columnsOf.has(mark)) columnsOf.set(mark, mark.rows());
    return columnsOf.get(mark);
  }
  // How many points a mark has, and a function that gives a column of each.
  function countOf(mark) {
    if (mark.values) return mark.values.length / (mark.mark === "whiskers" ? 3 : 2);
    if (mark.mark === "rule" || mark.mark === "image") return 1;
    const rows = rowsOf(mark);
    return Array.isArray(rows) ? rows.length : rows[mark.x].length;
  }
  function reader(mark, along) {
    const {values} = mark, column = mark[along], rows = rowsOf(mark);
    if (values) {
      const parts = mark.mark === "whiskers" ? 3 : 2, at = along === "x" ? 0 : parts - 1;
      return (i) => values[parts * i + at];
    }
    if (mark.mark === "rule") return () => mark.at[along] ?? null;
    if (typeof column === "number") return () => column;
    return Array.isArray(rows) ? (i) => rows[i][column] : (i) => rows[column][i];
  }
  const rowAt = (mark, i) => (Array.isArray(rowsOf(mark)) && rowsOf(mark)[i]) || {};
  const ofRow = (setting, row) => (typeof setting === "function" ? setting(row) : setting);
  const isShown = (mark, hidden) => !hidden.has(mark.name) && !(mark.tags || []).some((tag) => hidden.has(tag));

  // The first place of a rising list whose value is not below.
  function firstFrom(values, wanted) {
    let low = 0, high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] < wanted) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  // Distance of a place to the line between two.
  function toSegment(x, y, ax, ay, bx, by) {
    const dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy,
          share = squared > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / squared)) : 0;
    return Math.hypot(x - ax - share * dx, y - ay - share * dy);
  }

  // An axis of which a part is shown.
  const shown = (axis, window) =>
      (window && axis.type !== "category" ? {...axis, min: window[0], max: window[1]} : axis);

  class Plot {
    // `windows` {x, y}: what is shown of the axes, [from, to] or null; `top`: room above, pixels.
    constructor(view, {width, height, top = 0}, {hidden = new Set(), windows = {}} = {}) {
      Object.assign(this, {view, width, height: height + top, hidden, windows});
      const boxes =
          view.frames.map((f) => ({y: f.top + top, height: Math.max(6, f.height ?? height - f.top - f.bottom)}));
      this.ys = view.yAxes.map((axis, k) => this.vertical(axis, boxes[axis.frame || 0], k ? null : windows.y));
      // Words of an axis and its name have room on the left.
      const room = Math.max(
          0,
          ...this.ys.filter(({axis}) => !axis.hidden && !axis.bare && axis.type !== "category")
              .map((y) => 34 + y.wide));
      this.frames = boxes.map((box, k) => {
        const {pad = 0, ...f} = view.frames[k], left = Math.max(f.left, room);
        return {...box, pad, x: left - pad, width: Math.max(10, f.width ?? width - left - f.right) + 2 * pad};
      });
      this.xs = view.xAxes.map((axis, k) => {
        const {x, width: wide, pad} = this.frames[k];
        return new ricochet.Scale(shown(axis, windows.x), x + pad, x + wide - pad);
      });
      this.marks = view.marks.filter((mark) => isShown(mark, hidden))
                       .map((mark, k) => [mark, k])
                       .sort(([a, k], [b, l]) => (a.z ?? 2) - (b.z ?? 2) || k - l)
                       .map(([mark]) => mark);
      this.counts = new Map();  // of points that were drawn
      this.drawn = new Map();   // boxes of bars and cells
    }
    vertical(axis, {y, height}, window) {
      const first = axis.type === "category" ? [y, y + height] : [y + height, y],
            out = Object.assign(new ricochet.Scale(shown(axis, window), ...first), {vertical: true});
      out.wide = axis.hidden ? 0 : Math.max(0, ...out.ticks().map(({words}) => ricochet.widthOf(words)));
      return out;
    }
    // Scales and frame of a mark.
    placed(mark) {
      const y = this.ys[mark.yAxis || 0], frame = y.axis.frame || 0;
      return {x: this.xs[frame], y, frame: this.frames[frame]};
    }
    // Pixels of values, and the other way round.
    pixel([x, y], yAxis = 0) {
      const own = this.placed({yAxis});
      return [own.x.at(x), own.y.at(y)];
    }
    value([px, py], yAxis = 0) {
      const own = this.placed({yAxis});
      return [own.x.value(px), own.y.value(py)];
    }
    frameAt([x, y]) {
      return this.frames.findIndex((f) => x >= f.x && x <= f.x + f.width && y >= f.y && y <= f.y + f.height);
    }

    draw(pen) {
      this.pen = pen;
      this.stacks = new Map();
      this.ends = [];
      this.axes();
      for (const mark of this.marks) {
        const own = this.placed(mark);
        // A symbol at an edge is whole, unless a part of the axes is shown.
        const whole = !this.windows.x && !this.windows.y && ["line", "dots", "words"].includes(mark.mark),
              slack = whole ? 7 : 1, {frame} = own;
        pen.within(
            {x: frame.x - slack, y: frame.y - slack, width: frame.width + 2 * slack, height: frame.height + 2 * slack},
            () => this[mark.mark](mark, own));
      }
      this.sayEnds();
      return this;
    }
    axes() {
      const {pen} = this;
      this.frames.forEach((frame, f) => {
        const bottom = frame.y + frame.height, x = this.xs[f], line = (d, stroke) => pen.path(d, {stroke});
        const ys = this.ys.filter((y) => (y.axis.frame || 0) === f && !y.axis.hidden),
              xTicks = x.ticks().map((tick) => ({...tick, at: x.at(tick.value)}));
        let across = "", small = "";
        for (const {at, words} of x.axis.plain ? [] : xTicks)
          if (words) across += "M" + n(at) + " " + frame.y + "V" + bottom;
        for (const y of ys)
          for (const {value, words} of y.axis.plain || y.axis.type === "category" ? [] : y.ticks())
            if (words) across += "M" + frame.x + " " + n(y.at(value)) + "h" + frame.width;
        line(across, pale);
        for (const y of ys) {
          if (!y.axis.bare || y.axis.type !== "category") line("M" + frame.x + " " + frame.y + "V" + bottom, faint);
          this.sayHeights(y, frame);
        }
        line("M" + frame.x + " " + bottom + "h" + frame.width, faint);
        if (x.axis.bare) return;
        for (const {at, words} of xTicks) small += "M" + n(at) + " " + bottom + "v" + (words ? 5 : 3);
        line(small, faint);
        let last = -Infinity;
        for (const {at, words} of xTicks.sort((a, b) => a.at - b.at)) {
          const half = 0.5 * ricochet.widthOf(words), left = Math.min(at, this.width - half - 1) - half;
          if (!words || left < last + 6) continue;
          pen.text(words, left + half, bottom + 14, {align: "center"});
          last = left + 2 * half;
        }
        pen.text(
            ricochet.cutTo(x.axis.name || "", this.width - 8, {}),
            Math.min(frame.x + 0.5 * frame.width, this.width - 4 - 0.5 * ricochet.widthOf(x.axis.name || "")),
            bottom + 33, {align: "center"});
      });
    }
    sayHeights(y, frame) {
      const {pen} = this, {axis} = y;
      if (axis.type === "category") {
        if (axis.bare) return;
        const wide = frame.x - 9, tall = frame.height / axis.data.length;
        for (const {value, words} of y.ticks()) {
          const lines = ricochet.linesOf(words, wide).slice(0, Math.max(1, Math.floor(tall / letter)));
          lines.forEach(
              (line, k) => pen.text(
                  line, frame.x - 7, y.at(value) + letter * (k - 0.5 * (lines.length - 1)),
                  {align: "right", size: letter}));
        }
        return;
      }
      let small = "", last = Infinity;
      for (const {value, words} of y.ticks()) {
        const at = y.at(value);
        small += "M" + frame.x + " " + n(at) + "h-" + (words ? 5 : 3);
        if (!words || Math.abs(at - last) < letter + 2) continue;
        pen.text(words, frame.x - 8, at, {align: "right"});
        last = at;
      }
      pen.path(small, {stroke: faint});
      if (!axis.name) return;
      const name = ricochet.cutTo(axis.name, this.frames.length > 1 ? frame.height + 16 : this.height - 4),
            half = 0.5 * ricochet.widthOf(name);
      pen.text(
          name, Math.max(8, frame.x - Math.max(y.wide + 24, 46)),
          Math.min(Math.max(frame.y + 0.5 * frame.height, half + 2), this.height - half - 2),
          {align: "center", turned: true});
    }

    line(mark, {x, y, frame}) {
      const {pen} = this, xOf = reader(mark, "x"), yOf = reader(mark, "y"), count = countOf(mark),
            style = {stroke: ofRow(mark.colour, {}), width: mark.width, dash: mark.dash, cap: mark.cap};
      const at = this.visible(mark, xOf, count, x), places = [], kept = [];
      for (const i of at) {
        places.push(x.at(xOf(i)), y.at(yOf(i)));
        kept.push(i);
      }
      this.counts.set(mark, kept.length);
      let d = "", pen_down = false, area = "", first = 0;
      const base = frame.y + frame.height;
      for (let i = 0; i < places.length; i += 2) {
        if (!Number.isFinite(places[i]) || !Number.isFinite(places[i + 1])) {
          pen_down = false;
          continue;
        }
        const px = n(places[i]), py = n(Math.min(Math.max(places[i + 1], -1e5), 1e5));
        d += (pen_down ? "L" : "M") + px + " " + py;
        if (mark.area) area += (area ? "L" : "M" + px + " " + base + "L") + px + " " + py;
        if (!pen_down) first = px;
        pen_down = true;
        this.last = [px, py];
      }
      if (area) pen.path(area + "L" + this.last[0] + " " + base + "Z", {fill: style.stroke, opacity: mark.area});
      if (mark.width !== 0) pen.path(d, style);
      if (mark.symbol) this.stamp(mark, kept, places);
      if (mark.end && d)
        this.ends.push(
            {words: mark.end, x: this.last[0] + 8, y: this.last[1], colour: mark.endColour || style.stroke, frame});
    }
    // Points of a line that are seen, and their neighbours; of many, the least and the largest of each pixel.
    visible(mark, xOf, count, x) {
      let from = 0, to = count;
      if (!mark.rising || count <= dotsWhole) return Array.from({length: count}, (_, i) => i);
      const xs = rowsOf(mark)[mark.x], {min, max} = x.axis;
      from = Math.max(0, firstFrom(xs, min) - 1);
      to = Math.min(count, firstFrom(xs, max) + 2);
      if (to - from <= dotsWhole) return Array.from({length: to - from}, (_, i) => from + i);
      const yOf = reader(mark, "y"), out = [];
      for (let i = from; i < to;) {
        const pixel = Math.floor(x.at(xs[i]));
        let low = i, high = i, end = i;
        for (; end < to && Math.floor(x.at(xs[end])) === pixel; ++end) {
          if (yOf(end) < yOf(low) || Number.isNaN(yOf(low))) low = end;
          if (yOf(end) > yOf(high) || Number.isNaN(yOf(high))) high = end;
        }
        out.push(...ricochet.distinct([i, Math.min(low, high), Math.max(low, high), end - 1]));
        i = end;
      }
      return out;
    }
    dots(mark, {x, y}) {
      const xOf = reader(mark, "x"), yOf = reader(mark, "y"), count = countOf(mark),
            [right, down] = mark.shift || [0, 0], places = [], kept = [];
      for (let i = 0; i < count; ++i) {
        const px = x.at(xOf(i)) + right, py = y.at(yOf(i)) + down;
        if (!Number.isFinite(px) || !Number.isFinite(py)) continue;
        places.push(px, py);
        kept.push(i);
      }
      this.counts.set(mark, kept.length);
      if (mark.symbol === "dot") this.pen.squares(places, mark.size, mark.colour);
      else this.stamp(mark, kept, places);
    }
    // Symbols; those that look alike together.
    stamp(mark, kept, places) {
      const groups = new Map(),
            simple = [mark.colour, mark.size, mark.hollow].every((one) => typeof one !== "function");
      kept.forEach((i, k) => {
        if (!Number.isFinite(places[2 * k]) || !Number.isFinite(places[2 * k + 1])) return;
        const row = simple ? {} : rowAt(mark, i),
              look = [ofRow(mark.colour, row), ofRow(mark.size, row) || 8, Boolean(ofRow(mark.hollow, row))],
              key = simple ? "" : look.join();
        if (!groups.has(key)) groups.set(key, {look, at: []});
        groups.get(key).at.push(places[2 * k], places[2 * k + 1]);
      });
      for (const {look: [colour, size, hollow], at} of groups.values()) {
        const d = (shapes[mark.symbol] || circle)(0.5 * size), open = mark.symbol === "cross";
        this.pen.stamps(
            d, at,
            hollow || open ?
                {fill: open || mark.clear ? undefined : "#ffffff", stroke: colour, width: mark.edge || 1.6} :
                {fill: colour, opacity: mark.opacity});
      }
    }
    words(mark, {x, y}) {
      const xOf = reader(mark, "x"), yOf = reader(mark, "y"), count = countOf(mark);
      this.counts.set(mark, count);
      for (let i = 0; i < count; ++i)
        this.pen.text(
            rowAt(mark, i).mark, x.at(xOf(i)), y.at(yOf(i)),
            {align: "center", size: 14, bold: true, colour: mark.colour, halo: true});
    }
    whiskers({values, colour, ...mark}, {x, y}) {
      let d = "";
      for (let i = 0; i < values.length; i += 3)
        d += "M" + n(x.at(values[i])) + " " + n(y.at(values[i + 1])) + "V" + n(y.at(values[i + 2]));
      this.pen.path(d, {stroke: colour});
    }
    // Boxes of bars and cells, [left, top, right, bottom] of each row.
    boxes(mark) {
      const {x, y, frame} = this.placed(mark), count = countOf(mark), out = [];
      if (mark.mark === "bars") {
        const xOf = reader(mark, "x"), yOf = reader(mark, "y"), band = Math.abs(y.pixels),
              thick = mark.thick <= 1 ? mark.thick * band : Math.min(mark.thick, band), sums = this.sumsOf(mark.stack);
        for (let i = 0; i < count; ++i) {
          const row = yOf(i),
                from = mark.stack   ? sums.get(row) || 0 :
              x.axis.type === "log" ? x.axis.min :
                                      Math.max(0, x.axis.min),
                to = mark.stack ? from + xOf(i) : xOf(i), middle = y.at(row);
          if (mark.stack) sums.set(row, to);
          out.push([
            Math.min(x.at(from), x.at(to)), middle - 0.5 * thick, Math.max(x.at(from), x.at(to)), middle + 0.5 * thick
          ]);
        }
        return out;
      }
      const side = (along, k) => {
        const column = Array.isArray(mark[along]) ? mark[along][k] : mark[along];
        return column === null || column === undefined ? () => null : reader({...mark, [along]: column}, along);
      };
      const [left, right, low, high] = [side("x", 0), side("x", 1), side("y", 0), side("y", 1)],
                               band = Array.isArray(mark.y) || mark.y === undefined || mark.y === null ?
          0 :
          0.5 * Math.abs(y.pixels) - 0.5;
      const edge = (scale, value, otherwise) => (value === null ? otherwise : scale.at(value));
      for (let i = 0; i < count; ++i) {
        const a = edge(x, left(i), frame.x), b = edge(x, right(i), frame.x + frame.width),
              c = edge(y, low(i), frame.y + frame.height), d = edge(y, high(i), frame.y);
        out.push([Math.min(a, b), Math.min(c, d) - band, Math.max(a, b), Math.max(c, d) + band]);
      }
      return out;
    }
    sumsOf(stack) {
      if (!this.stacks.has(stack)) this.stacks.set(stack, new Map());
      return this.stacks.get(stack);
    }
    bars(mark) { this.cells(mark); }
    cells(mark) {
      const boxes = this.boxes(mark), known = new Map();
      this.counts.set(mark, boxes.length);
      this.drawn.set(mark, boxes);
      boxes.forEach(([left, top, right, bottom], i) => {
        if (![left, top, right, bottom].every(Number.isFinite)) return;
        // Whole pixels, so that neighbours of one colour leave no seam and the narrowest cell is seen.
        const from = mark.mark === "cells" ? Math.floor(left) : left,
              to = mark.mark === "cells" ? Math.max(Math.floor(right), from + 1) : right,
              colour = ofRow(mark.colour, rowAt(mark, i));
        known.set(
            colour,
            (known.get(colour) || "") + "M" + n(from) + " " + n(top) + "H" + n(to) + "V" + n(bottom) + "H" + n(from) +
                "Z");
      });
      for (const [fill, d] of known)
        this.pen.path(d, {fill, opacity: mark.opacity, ...(mark.edge ? {stroke: "#ffffff", width: mark.edge} : {})});
      if (mark.said)
        boxes.forEach(([left, top, right, bottom], i) => {
          const lines = String(ofRow(mark.said, rowAt(mark, i)) || "").split("\n").filter(Boolean),
                colour = mark.letters || ink;
          if (lines.some((line) => ricochet.widthOf(line) > right - left - 4)) return;
          lines.forEach(
              (line, k) => this.pen.text(
                  line, 0.5 * (left + right),
                  mark.low ? bottom - 9 : 0.5 * (top + bottom) + 13 * (k - 0.5 * (lines.length - 1)),
                  {align: "center", colour}));
        });
    }
    rule(mark, {x, y, frame}) {
      const {at, colour = "#777777", dash, width} = mark, px = x.at(at.x), py = y.at(at.y);
      if (at.x !== undefined) {
        this.pen.path("M" + n(px) + " " + frame.y + "V" + (frame.y + frame.height), {stroke: colour, dash, width});
        const before = px + 8 + ricochet.widthOf(mark.said || "") > this.width;
        this.pen.text(
            mark.said, before ? px - 4 : px + 4, frame.y + 9, {colour, halo: true, align: before ? "right" : "left"});
      } else {
        this.pen.path("M" + frame.x + " " + n(py) + "h" + frame.width, {stroke: colour, dash, width});
        if (mark.said) this.pen.text(mark.said, frame.x + 6, py - 8, {colour, halo: true});
      }
    }
    image(mark, {x, y}) {
      const [left, right] = mark.x.map((value) => x.at(value)), [bottom, top] = mark.y.map((value) => y.at(value));
      this.pen.image(mark.picture(this.pen.paint(mark.colour)), left, top, right - left, bottom - top);
      this.counts.set(mark, 1);
    }
    // Words behind ends, moved up or down so that none covers another; what then finds no room is left out.
    sayEnds() {
      const gap = letter + 1,
            wide =
                new Map(this.ends.map((end) => [end, Math.min(ricochet.widthOf(end.words), this.width - end.x - 2)])),
            besides = (a, b) => a.x < b.x + wide.get(b) && b.x < a.x + wide.get(a);
      const order = this.ends
                        .filter(
                            ({x, y, frame}) =>
                                x <= frame.x + frame.width + 12 && y >= frame.y - 2 && y <= frame.y + frame.height + 2)
                        .sort((a, b) => a.y - b.y),
            placed = [];
      for (const end of order) {
        // What is the same and ends near shares its words.
        const same =
            placed.find((other) => other.words === end.words && besides(end, other) && end.y - other.y < 3 * gap);
        if (same) {
          same.colour = ink;
          continue;
        }
        end.at = end.y;
        for (const other of placed)
          if (besides(end, other) && end.at < other.at + gap) end.at = other.at + gap;
        placed.push(end);
      }
      // What ran out below goes up again.
      placed.reverse().forEach((end, k) => {
        end.at = Math.min(end.at, end.frame.y + end.frame.height - 4);
        for (const other of placed.slice(0, k))
          if (besides(end, other) && end.at > other.at - gap) end.at = other.at - gap;
      });
      for (const end of placed)
        if (end.at > 2)
          this.pen.text(ricochet.cutTo(end.words, wide.get(end)), end.x, end.at, {colour: end.colour, halo: true});
    }

    // What lies within so many pixels of a place: {mark, i, row, x, y, place}, null where nothing does. Points and
    // lines before what covers an area. `accept` tells marks that count.
    at(place, reach, accept = () => true) {
      const [px, py] = place, frame = this.frames[this.frameAt(place)];
      let best = null, nearest = reach;
      if (!frame) return null;
      const take = (away, mark, i) => {
        if (away >= nearest) return;
        nearest = away;
        best = {mark, i};
      };
      for (const mark of this.marks) {
        const own = this.placed(mark);
        if (mark.silent || own.frame !== frame || !accept(mark)) continue;
        if (mark.mark === "line" || mark.mark === "dots" || mark.mark === "words")
          this.nearestOf(mark, own, px, py, reach, take);
      }
      for (const mark of best ? [] : this.marks.slice().reverse()) {
        if (mark.silent || this.placed(mark).frame !== frame || !accept(mark) || best) continue;
        if (mark.mark === "image") best = {mark, i: 0};
        if (this.drawn.has(mark)) {
          const i = this.drawn.get(mark).findIndex(
              ([left, top, right, bottom]) =>
                  px >= left && px <= Math.max(right, left + 1) && py >= top && py <= bottom);
          if (i >= 0) best = {mark, i};
        }
      }
      return best && this.found(best.mark, best.i, place);
    }
    found(mark, i, place) {
      const over = mark.mark === "image" || (mark.mark === "cells" && Array.isArray(mark.x)),
            [x, y] = over ? this.value(place, mark.yAxis) : [reader(mark, "x")(i), reader(mark, "y")(i)];
      return {mark, i, row: rowAt(mark, i), x, y, place};
    }
    nearestOf(mark, {x, y}, px, py, reach, take) {
      const xOf = reader(mark, "x"), yOf = reader(mark, "y"),
            joined = mark.mark === "line" && !mark.prefer && mark.width !== 0, [right, down] = mark.shift || [0, 0];
      let from = 0, to = countOf(mark), before = null;
      if (mark.rising) {
        const xs = rowsOf(mark)[mark.x];
        from = Math.max(0, firstFrom(xs, x.value(px - reach)) - 1);
        to = Math.min(to, firstFrom(xs, x.value(px + reach)) + 1);
      }
      for (let i = from; i < to; ++i) {
        const ax = x.at(xOf(i)) + right;
        if (!joined && Math.abs(ax - px) > reach) continue;
        const ay = y.at(yOf(i)) + down, away = Math.hypot(ax - px, ay - py);
        if (Number.isNaN(away)) before = null;
        else {
          take(away + (mark.prefer && !mark.prefer(i, rowsOf(mark)) ? 0.5 * reach : 0), mark, i);
          if (joined && before)
            take(
                toSegment(px, py, before[0], before[1], ax, ay) + 1e-6, mark,
                Math.hypot(before[0] - px, before[1] - py) < away ? i - 1 : i);
          before = [ax, ay];
        }
      }
    }
    // The sample of each curve nearest to an x.
    along(px) {
      const out = [];
      for (const mark of this.marks.filter((one) => one.mark === "line" && !one.silent && countOf(one))) {
        const {x} = this.placed(mark), xs = rowsOf(mark)[mark.x] || [], i = firstFrom(xs, x.value(px)),
              k = i > 0 && (i === xs.length || px - x.at(xs[i - 1]) < x.at(xs[i]) - px) ? i - 1 : i;
        if (xs.length) out.push(this.found(mark, k, [px, 0]));
      }
      return out;
    }
  }

  Object.assign(ricochet, {Plot, plot: {rowsOf, countOf, reader, rowAt, isShown, shapes}, ink, faint});
}
