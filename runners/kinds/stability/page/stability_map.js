// For each numeric parameter with at least three values its map over the step: cells coloured by the prediction, marked by what was observed, with the
// predicted boundary and the observed one over them.
{
  const { Interval, numberOf } = ricochet;
  const unstable = "#D55E00", colours = { "predicted stable": "#D6E6F4", "predicted marginal": "#F6EBB0", "predicted unstable": unstable, "not predicted": "#E3E3E3" };
  const dark = "#222222", predictedColour = "#0072B2", mostNotes = 6;

  // Bands of neighbouring values meet half-way.
  function shareAxis(bands, logarithmic) {
    const to = logarithmic ? Math.log : (v) => v, from = logarithmic ? Math.exp : (v) => v, n = bands.length, at = (k) => to(bands[k].value);
    bands.forEach((band, i) => {
      const below = i > 0 ? at(i - 1) : 2 * at(i) - at(Math.min(i + 1, n - 1)), above = i + 1 < n ? at(i + 1) : 2 * at(i) - at(i > 0 ? i - 1 : 0);
      band.low = from(0.5 * (below + at(i)));
      band.high = from(0.5 * (at(i) + above));
    });
  }
  // Edges of the steps of a band, half-way on the logarithmic scale.
  function edges(cells) {
    const n = cells.length, ratio = n > 1 ? Math.sqrt(cells[1].step / cells[0].step) : 1.5, out = [cells[0].step / ratio];
    for (let i = 0; i + 1 < n; ++i) out.push(Math.sqrt(cells[i].step * cells[i + 1].step));
    out.push(n > 1 ? cells[n - 1].step * Math.sqrt(cells[n - 1].step / cells[n - 2].step) : cells[0].step * ratio);
    return out;
  }
  // Darker the faster it grows: 1e-6 per step pale, tenfold per step full.
  const shade = (cell) => (cell.prediction === "predicted unstable" ? ricochet.lighten(unstable, 0.75 - 0.6 * Math.min(Math.max((Math.log10(cell.worst - 1) + 6) / 7, 0), 1)) : colours[cell.prediction]);
  function cellText(cell) {
    const radius = cell.worst === null ? "" : ", radius " + ricochet.format.text(cell.worst, 6), seen = cell.behaviour ? ", observed " + cell.behaviour : "";
    return [cell.prediction + radius + seen, cell.marginal, cell.reason].filter(Boolean).join("; ");
  }
  function disagreementText(row) {
    const { text } = ricochet.format, more = row.steps > 1 ? " to " + text(row.to, 3) + " s (" + row.steps + " steps)" : "";
    return "h = " + text(row.from, 3) + " s" + more + ": predicted " + row.predicted + ", observed " + row.observed;
  }

  // The axis ends with the outer cells; over many decades, where labels need whole ones, with the next decade.
  function frame(axis, range) {
    axis.splitLine = { show: false };
    let shown = range;
    if (axis.type === "log" && range.high > 1e9 * range.low) {
      shown = ricochet.wholeDecades(range);
      axis.interval = Math.ceil(Math.log10(shown.high / shown.low) / 6);
    } else {
      axis.axisLabel.showMinLabel = axis.axisLabel.showMaxLabel = false;   // half a cell beyond the outer values: no numbers to read
    }
    return Object.assign(axis, { min: shown.low, max: shown.high });
  }

  class StabilityMap {
    constructor(data, stability, column) {
      Object.assign(this, { data, view: data.view, stability, column });
      const values = new Interval().include(...data.view.all.map((one) => numberOf(one, column)).filter((value) => value !== null));
      this.logarithmic = values.low > 0 && values.high >= 9 * values.low;
    }
    figure() {
      const { column } = this, charts = [];
      // The law plays no part while nothing touches.
      for (const contact of ["open", "closed"]) if (contact === "closed" || ricochet.roleOf(column) !== "contact") charts.push(...this.charts(contact));
      if (!charts.length) return null;
      const used = new Set(charts.flatMap((chart) => chart.views[0].option.series.map((series) => series.name))), legend = [];
      for (const name of Object.keys(colours)) legend.push({ name, colour: name === "predicted unstable" ? ricochet.lighten(unstable, 0.4) : colours[name], dash: "", symbol: "rect" });
      legend.push({ name: "observed stable", colour: "#5a5a5a", dash: "0 30", symbol: "circle" }, { name: "observed unstable", colour: dark, dash: "0 30", symbol: "diamond" });
      legend.push({ name: "predicted limit", colour: predictedColour, dash: "", symbol: "" }, { name: "observed limit", colour: dark, dash: ricochet.svgDash(1), symbol: "" });
      return {
        id: "stability-map-" + ricochet.slug(column), title: "Stability over step and " + column, views: ["map"], charts, legend: legend.filter((entry) => used.has(entry.name)),
        caption: "Background: what one step's spectrum predicts, darker the faster it grows. Marks: what marching showed. Closed contact is predicted with points held on both sides and observed in the scene itself, which is open as well: its background is the worse of both.",
      };
    }
    charts(contact) {
      const { view, column, stability } = this, cases = stability.cases(contact).filter((one) => numberOf(one, column) !== null);
      const others = (contact === "closed" ? view.varying : view.varyingWithout(["contact"])).filter((name) => name !== column);
      return view.group(cases, others).map((facet) => {
        const byValue = new Map();
        for (const one of facet.cases) if (!byValue.has(numberOf(one, column))) byValue.set(numberOf(one, column), one);
        if (byValue.size < 2) return null;
        const bands = Array.from(byValue).sort((a, b) => a[0] - b[0]).map(([value, one]) => ({ value, one, cells: stability.cells(one, contact), limits: stability.limits(one, contact) }));
        shareAxis(bands, this.logarithmic);
        return { title: contact + (facet.label ? " · " + facet.label : ""), views: [this.draw(bands)], notes: this.notes(bands, contact) };
      }).filter(Boolean);
    }
    draw(bands) {
      const x = ["step h", "s"], y = [this.column, this.view.unit(this.column) || "1"], xs = new Interval(), ys = new Interval();
      for (const band of bands) {
        xs.include(...edges(band.cells));
        ys.include(band.low, band.high);
      }
      const along = frame(ricochet.logAxis(x, xs, false), xs), up = frame(this.logarithmic ? ricochet.logAxis(y, ys, true) : ricochet.valueAxis(y, ys, true), ys);
      const out = ricochet.view(x, y, along, up);
      out.option.series.push(...background(bands, along, up), ...limits(bands), ...marks(bands));
      return out;
    }
    notes(bands, contact) {
      let out = bands.flatMap((band) => this.stability.disagreements(band.one, contact).map((row) => this.column + " " + ricochet.format.exact(band.value) + ": " + disagreementText(row)));
      const more = out.length - mostNotes;
      if (more > 0) out = out.slice(0, mostNotes).concat(["and " + ricochet.format.count(more, "range of disagreement", "ranges of disagreement") + " more"]);
      const refused = bands.flatMap((band) => band.cells.filter((cell) => cell.status === "refused" || cell.status === "failed").map((cell) => "⊘ " + cell.reason));
      return out.concat(ricochet.distinct(refused));
    }
  }

  function background(bands, x, y) {
    const areas = new Map();
    for (const band of bands) {
      const at = edges(band.cells), low = band === bands[0] ? y.min : band.low, high = band === bands[bands.length - 1] ? y.max : band.high;
      at[0] = Math.min(at[0], x.min);
      at[at.length - 1] = Math.max(at[at.length - 1], x.max);
      band.cells.forEach((cell, i) => {
        if (!areas.has(cell.prediction)) areas.set(cell.prediction, []);
        areas.get(cell.prediction).push([{ coord: [at[i], low], itemStyle: { color: shade(cell) } }, { coord: [at[i + 1], high] }]);
      });
    }
    return Array.from(areas).map(([name, data]) => ({
      type: "line", name, symbol: "none", color: colours[name], data: [],
      markArea: { silent: true, z: 0, label: { show: false }, animation: false, itemStyle: { opacity: 1, borderWidth: 0 }, data },
    }));
  }
  function limits(bands) {
    return [["predicted", "expected", predictedColour, 4, 0], ["observed", "observed", dark, 1.8, 1]].map(([name, column, colour, width, dash]) => {
      if (bands.every((band) => band.limits[column] === null)) return null;
      // A boundary is a line across the band of its value.
      const data = bands.flatMap((band) => {
        const limit = band.limits[column];
        if (limit === null) return [{ value: ["-", "-"] }];
        const text = name + " limit h = " + ricochet.format.text(limit, 5) + " s";
        return [band.low, band.value, band.high].map((at) => ({ value: [limit, at], text }));
      });
      return { type: "line", name: name + " limit", symbol: "none", z: 4, color: colour, lineStyle: { color: colour, width, type: ricochet.dash(dash) }, data };
    }).filter(Boolean);
  }
  function marks(bands) {
    const of = (accept) => bands.flatMap((band) => band.cells.filter(accept).map((cell) => ({ value: [cell.step, band.value], text: cellText(cell) })));
    // Cells that were not marched still tell what is predicted when pointed at.
    return [["observed stable", "circle", 4, "#5a5a5a", (cell) => cell.behaviour && !cell.unstable], ["observed unstable", "diamond", 8, dark, (cell) => cell.behaviour && cell.unstable],
      ["prediction", "circle", 8, "rgba(0,0,0,0)", (cell) => !cell.behaviour]].map(([name, symbol, size, colour, accept]) => {
      const data = of(accept);
      return data.length ? { type: "scatter", name, symbol, symbolSize: size, z: 5, color: colour, itemStyle: { color: colour }, data } : null;
    }).filter(Boolean);
  }

  ricochet.figure("stability-map", (data) => {
    const stability = ricochet.stability(data), numeric = (column) => data.view.values(column).filter((text) => Number.isFinite(Number(text))).length >= 3;
    return data.view.varying.filter(numeric).map((column) => new StabilityMap(data, stability, column).figure()).filter(Boolean);
  });
}
