// Images of the basins of attraction, one per case, with the difference to the first case as their second view.
{
  ricochet.manyOrbits = true;
  const outcomes = [["differs", "#C2410C"], ["the same", "#CFE3F2"], ["not decided", "#DADADA"]], absent = 255;

  class Basins {
    constructor(data) {
      Object.assign(this, {data, view: data.view}, data.page.basins);
      [this.across, this.up] =
          [this.xs, this.ys].map((values) => new ricochet.Interval().include(...ricochet.cellEdges(values)));
      this.counts = data.rowsBy("basin_counts", ["case"]);
      this.failures = data.rowsBy("basin_failures", ["case"]);
    }
    name(id) { return this.view.label(this.data.byId.get(id)) || "all cases"; }
    cells(id) { return this.data.block(id + "/cells"); }
    // What a cell ends in: name and colour.
    end(id, {column, row}) {
      return this.labels[this.cells(id)[row * this.xs.length + column]] || ["not known yet", "#fff"];
    }

    figure() {
      const {grids} = this, compares = grids.length > 1,
            entry = ([name, colour], heading) => ricochet.swatch(name, colour, "rect", heading);
      const caption = this.xs.length + " × " + this.ys.length + " cells: the attractor that each ends in." +
          (compares ? " Difference: cells that end elsewhere than with " + this.name(grids[0]) + "." : "") +
          " White: not known yet. Click a cell for the command that marches it.";
      const charts = grids.map((id) => ({
                                 cases: [this.data.byId.get(id)],
                                 title: this.name(id) + (this.data.byId.get(id).partial ? " (partial)" : ""),
                                 height: 420,
                                 views: [this.image(id)].concat(compares ? [this.difference(id)] : []),
                                 notes: this.notes(id)
                               }));
      return {
        id: "basins",
        answers: true,
        title: "Basins of attraction",
        caption,
        views: ["basins"].concat(compares ? ["difference"] : []),
        charts,
        linked: true,
        legend: this.labels.map((label) => entry(label, "Ends in"))
                    .concat(compares ? outcomes.map((one) => entry(one, "Difference")) : [])
      };
    }
    notes(id) {
      const {count, mark} = ricochet.format, out = [], [counts] = this.counts(id);
      if (counts && counts.filled > 0)
        out.push(
            counts.filled + " of " + counts.cells +
            " cells take the end of a marched one of their basin: only boundaries were marched cell by cell.");
      if (counts && counts.no_starts > 0)
        out.push(counts.no_starts + " of " + counts.cells + " cells are no starts: they begin beyond a stop.");
      for (const row of this.failures(id))
        out.push(
            mark("failed") + " " + count(row.cells, "cell failed", "cells failed") +
            (row.reason ? ": " + row.reason : ""));
      return out;
    }
    frame(id, other) {
      const [x, y] = [[this.x, this.across], [this.y, this.up]].map(
          ([quantity, range]) => ({...ricochet.valueAxis(quantity, range), plain: true})),
                out = ricochet.view(this.x, this.y, x, y);
      out.words = ({x: across, y: up}) => this.words(id, other, this.cellAt(id, across, up));
      out.open = ({x: across, y: up}) => this.open(this.cellAt(id, across, up));
      return out;
    }
    // Cells that `wanted` takes in one colour, the others clear; several pixels a cell, so that edges stay sharp.
    series([name, colour], wanted) {
      const drawn = new Map();  // by colour: that of a dark screen is not that of paper
      const draw = (fill) => {
        const columns = this.xs.length, rows = this.ys.length,
              each = Math.max(1, Math.ceil(1000 / Math.max(columns, rows)));
        const canvas = Object.assign(document.createElement("canvas"), {width: each * columns, height: each * rows});
        const context = canvas.getContext("2d");
        context.fillStyle = fill;
        for (let row = 0; row < rows; ++row)
          for (let from = 0; from < columns;) {
            let to = from;
            while (to < columns && wanted(row * columns + to)) ++to;
            if (to > from) context.fillRect(each * from, each * (rows - 1 - row), each * (to - from), each);
            from = Math.max(to, from + 1);
          }
        drawn.set(fill, canvas);
        return canvas;
      };
      const {across, up} = this;
      return {
        mark: "image",
        name,
        colour,
        x: [across.low, across.high],
        y: [up.low, up.high],
        picture: (fill) => drawn.get(fill) || draw(fill)
      };
    }
    image(id) {
      const out = this.frame(id), cells = this.cells(id);
      this.labels.forEach((label, k) => {
        if (cells.includes(k)) out.marks.push(this.series(label, (i) => cells[i] === k));
      });
      return out;
    }
    difference(id) {
      const first = this.grids[0], out = this.frame(id, first), own = this.cells(id), other = this.cells(first),
            [counts] = this.counts(id);
      const decided = (cell) => cell !== absent && this.labels[cell][2],
            starts = (cell) => cell === absent || this.labels[cell][3],
            outcome = (i) =>
                (!starts(own[i]) && !starts(other[i])       ? 3 :
                     !decided(own[i]) || !decided(other[i]) ? 2 :
                     own[i] === other[i]                    ? 1 :
                                                              0);
      const neither = this.labels.find((label) => !label[3]);
      outcomes.forEach((one, k) => {
        if ([counts.differ, counts.same, counts.undecided][k] > 0)
          out.marks.push(this.series(one, (i) => outcome(i) === k));
      });
      if (neither) out.marks.push(this.series(neither, (i) => outcome(i) === 3));
      const share = counts.share === null ? "" : " (" + ricochet.format.share(counts.share) + ")";
      out.notes.push(
          id === first ? "This is what the others are compared with." :
                         counts.differ + " of " + counts.decided + " cells that both decide differ" + share + ".");
      return out;
    }

    // The cell at values of the axes.
    cellAt(id, x, y) {
      const part = (value, {low, high}, n) =>
          Math.min(n - 1, Math.max(0, Math.floor((value - low) / (high - low) * n)));
      return {id, column: part(x, this.across, this.xs.length), row: part(y, this.up, this.ys.length)};
    }
    placeWords({column, row}) {
      const {unit, shown} = ricochet.format;
      return [[this.x, this.xs[column]], [this.y, this.ys[row]]].map(
          ([quantity, value]) => quantity[0] + " = " + shown(value, 9) + unit(quantity));
    }
    words(id, other, place) {
      const {escape} = ricochet.format;
      return "<div>" + this.placeWords(place).map(escape).join("<br>") + '</div><div class="tip-row">' +
          escape(this.end(id, place)[0]) + "</div>" +
          (other !== undefined && other !== id ?
               '<div class="fine">the other: ' + escape(this.end(other, place)[0]) + "</div>" :
               "") +
          '<div class="fine">click: its command</div>';
    }
    open(place) {
      const {sidePanel} = ricochet;
      sidePanel.open(place, "The chosen cell", this.end(place.id, place)[1], this.placeWords(place).join(", "), []);
      for (const id of this.grids) {
        sidePanel.say(
            this.name(id) + ": " + this.end(id, place)[0] + (id === place.id ? ". The same cell again:" : ""));
        if (id === place.id)
          sidePanel.command(
              sidePanel.commandOf(this.data.study.name, id) + " --cell=" + this.xs[place.column] + "," +
              this.ys[place.row]);
      }
    }
  }

  ricochet.figure(
      "basins", (data) => (data.page.basins && data.page.basins.grids.length ? [new Basins(data).figure()] : []));
}
