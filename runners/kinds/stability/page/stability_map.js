// For each numeric parameter with at least three values, its map over the step. Cells are coloured by the prediction
// and marked by what was observed. The predicted boundary and the observed one lie over them.
{
  const {Interval, numberOf} = ricochet;
  const unstable = "#D55E00", colours = {
    "predicted stable": "#D6E6F4",
    "predicted marginal": "#F6EBB0",
    "predicted unstable": unstable,
    "not predicted": "#E3E3E3"
  };
  const dark = "#222222", mostNotes = 6;

  // Boundaries: name, column of `stability_limits`, colour, width, dash. What was observed: name, symbol, size, colour;
  // cells that were not marched still tell what is predicted when pointed at.
  const boundaries = [["predicted", "expected", "#0072B2", 4, 0], ["observed", "observed", dark, 1.8, 1]];
  const observations = [
    ["observed stable", "circle", 4, "#5a5a5a"], ["observed unstable", "diamond", 8, dark],
    ["prediction", "circle", 8, "transparent"]
  ];
  const seen = (cell) => (cell.behaviour ? (cell.unstable ? "observed unstable" : "observed stable") : "prediction");

  const stepEdges = (cells) => ricochet.cellEdges(cells.map((cell) => cell.step), true, Math.log(1.5));
  // Darker the faster it grows: 1e-6 per step pale, tenfold per step full.
  const shade = (cell) =>
      (cell.prediction === "predicted unstable" ?
           ricochet.lighten(unstable, 0.75 - 0.6 * Math.min(Math.max((Math.log10(cell.worst - 1) + 6) / 7, 0), 1)) :
           colours[cell.prediction]);
  function cellText(cell) {
    const radius = cell.worst === null ? "" : ", radius " + ricochet.format.text(cell.worst, 6),
          behaviour = cell.behaviour ? ", observed " + cell.behaviour : "";
    return [cell.prediction + radius + behaviour, cell.marginal, cell.reason].filter(Boolean).join("; ");
  }
  function disagreementText(row) {
    const {text} = ricochet.format,
          more = row.steps > 1 ? " to " + text(row.to, 3) + " s (" + row.steps + " steps)" : "";
    return "h = " + text(row.from, 3) + " s" + more + ": predicted " + row.predicted + ", observed " + row.observed;
  }

  // The axis ends with the outer cells; over many decades, where labels need whole ones, with the next decade.
  function frame(axis, range) {
    const {low, high} = axis.type === "log" && range.high > 1e9 * range.low ? ricochet.wholeDecades(range) : range;
    return {...axis, min: low, max: high, plain: true};
  }

  class StabilityMap {
    constructor(data, stability, column) {
      Object.assign(this, {view: data.view, stability, column});
      this.logarithmic =
          ricochet.logarithmicAxis(new Interval().include(...data.view.all.map((one) => numberOf(one, column))));
    }
    figure() {
      const {column} = this, charts = [];
      // The law plays no part while nothing touches.
      for (const contact of ["open", "closed"])
        if (contact === "closed" || ricochet.roleOf(column) !== "contact") charts.push(...this.charts(contact));
      if (!charts.length) return null;
      const used = ricochet.drawnNames(charts), {swatch, lighten} = ricochet;
      const legend =
          Object.entries(colours)
              .map(
                  ([name, colour]) =>
                      ({name, colour: name === "predicted unstable" ? lighten(unstable, 0.4) : colour, symbol: "rect"}))
              .concat([
                ...observations.slice(0, 2).map(([name, symbol, , colour]) => swatch(name, colour, symbol)),
                ...boundaries.map(
                    ([name, , colour, , dash]) => ({name: name + " limit", colour, dash: ricochet.svgDash(dash)})),
              ]);
      return {
        id: "stability-map-" + ricochet.slug(column),
        title: "Stability over step and " + column,
        views: ["map"],
        charts,
        legend: legend.filter((entry) => used.has(entry.name)),
        measured: {...this.stability.measured, along: column},
        caption:
            "Background: what one step's spectrum predicts, darker the faster it grows. Marks: what marching showed. " +
            "Closed contact is predicted with points held on both sides and observed in the scene itself, which is " +
            "open as well: its background is the worse of both.",
      };
    }
    charts(contact) {
      const {view, column, stability} = this,
                           cases = stability.cases(contact).filter((one) => numberOf(one, column) !== null);
      const others =
          (contact === "closed" ? view.varying : view.varyingWithout(["contact"])).filter((name) => name !== column);
      return view.group(cases, others)
          .map((facet) => {
            const values = ricochet.distinct(facet.cases.map((one) => numberOf(one, column))).sort((a, b) => a - b),
                  at = ricochet.cellEdges(values, this.logarithmic);
            if (values.length < 2) return null;
            const bands = values.map((value, k) => {
              const one = facet.cases.find((other) => numberOf(other, column) === value);
              return {
                value,
                low: at[k],
                high: at[k + 1],
                one,
                cells: stability.cells(one, contact),
                limits: stability.limits(one, contact)
              };
            });
            return {
              cases: facet.cases,
              by: others,
              part: contact,
              title: contact + (facet.label ? " · " + facet.label : ""),
              views: [this.draw(bands)],
              notes: this.notes(bands, contact)
            };
          })
          .filter(Boolean);
    }
    draw(bands) {
      const x = ["step h", "s"], y = [this.column, this.view.unit(this.column) || "1"];
      const xs = new Interval().include(...bands.flatMap((band) => stepEdges(band.cells))),
            ys = new Interval().include(...bands.flatMap((band) => [band.low, band.high]));
      const along = frame(ricochet.logAxis(x, xs), xs), up = frame(ricochet.axisOf(this.logarithmic, y, ys), ys),
            out = ricochet.view(x, y, along, up);
      out.marks.push(...background(bands, along, up));
      // A boundary is a line across the band of its value, and there is none where the band has no limit.
      for (const [name, column, colour, width, dash] of boundaries) {
        if (bands.every((band) => band.limits[column] === null)) continue;
        const rows = bands.flatMap((band) => {
          const limit = band.limits[column], text = name + " limit h = " + ricochet.format.text(limit, 5) + " s";
          return [band.low, band.value, band.high].map((at) => ({limit, at, text}));
        });
        ricochet.draw(
            out, rows, {x: "limit", y: "at"},
            {...ricochet.line(name + " limit", colour, width, ricochet.dash(dash)), z: 4});
      }
      const cells = bands.flatMap(
          (band) => band.cells.map(
              (cell) =>
                  ({case: band.one.id, step: cell.step, value: band.value, seen: seen(cell), text: cellText(cell)})));
      for (const [name, symbol, size, colour] of observations)
        ricochet.draw(out, cells, {x: "step", y: "value"}, ricochet.dot(name, colour, symbol, size, 5), {seen: name});
      return out;
    }
    notes(bands, contact) {
      let out = bands.flatMap(
          (band) =>
              this.stability.disagreements(band.one, contact)
                  .map((row) => this.column + " " + ricochet.format.exact(band.value) + ": " + disagreementText(row)));
      const more = out.length - mostNotes;
      if (more > 0)
        out = out.slice(0, mostNotes).concat([
          "and " + ricochet.format.count(more, "range of disagreement", "ranges of disagreement") + " more"
        ]);
      const refused = bands.flatMap(
          (band) => band.cells.filter((cell) => cell.status === "refused" || cell.status === "failed")
                        .map((cell) => "⊘ " + cell.reason));
      return out.concat(ricochet.distinct(refused));
    }
  }

  // A cell per step and value, to the edges of the frame; a mark per prediction.
  function background(bands, x, y) {
    const cells = bands.flatMap((band) => {
      const at = stepEdges(band.cells), low = band === bands[0] ? y.min : band.low,
            high = band === bands[bands.length - 1] ? y.max : band.high;
      at[0] = Math.min(at[0], x.min);
      at[at.length - 1] = Math.max(at[at.length - 1], x.max);
      return band.cells.map(
          (cell, i) => ({name: cell.prediction, from: at[i], to: at[i + 1], low, high, shade: shade(cell)}));
    });
    return Array.from(ricochet.groupBy(cells, (one) => [one.name]), ([name, rows]) => ({
                                                                      mark: "cells",
                                                                      name,
                                                                      rows,
                                                                      x: ["from", "to"],
                                                                      y: ["low", "high"],
                                                                      colour: (row) => row.shade,
                                                                      silent: true,
                                                                      z: 0
                                                                    }));
  }

  ricochet.figure("stability-map", (data) => {
    const stability = ricochet.stability(data),
          numeric = (column) => data.view.values(column).filter((text) => Number.isFinite(Number(text))).length >= 3;
    return data.view.varying.filter(numeric)
        .map((column) => new StabilityMap(data, stability, column).figure())
        .filter(Boolean);
  });
}
