// Spectral radius of one step and its growth against the step: a chart for the open structure, one for closed contact, a curve per method.
{
  const { Interval } = ricochet;
  const heights = [{ name: "spectral radius", column: "radius", above: 0, none: "Nothing is predicted.", frame: [0.1, 10] },
    { name: "growth per step", column: "growth", above: 1e-9, none: "Nothing grows.", frame: [1e-9, 1e-6] }];   // below 1e-9 a radius is one to round-off

  const heightOf = (height, cell) => (cell[height.column] !== null && cell[height.column] > height.above ? cell[height.column] : null);
  function pointText(cell) {
    return ["radius " + ricochet.format.text(cell.radius, 9), cell.marginal, cell.reason].filter(Boolean).join("; ");
  }

  function chart(stability, height, facet, contact, range) {
    const x = ["step h", "s"], y = [height.name, "1"], grows = height.column === "growth";
    let frame = range.empty ? new Interval(...height.frame) : range.copy();
    if (!grows) frame = ricochet.wholeDecades(frame).include(0.1, 10);
    const out = ricochet.view(x, y, ricochet.logAxis(x, stability.steps, false), [ricochet.logAxis(y, frame, true), ricochet.gutterAxis()]), { series } = out.option, flat = [];
    if (range.empty) out.notes.push(height.none);
    if (!grows)   // |r| = 1
      series.push({ type: "line", name: "unit circle", symbol: "none", silent: true, z: 1, color: ricochet.faint, lineStyle: { color: ricochet.faint, width: 1, type: "solid" }, data: [out.option.xAxis.min, out.option.xAxis.max].map((end) => ({ value: [end, 1] })) });
    for (const curve of facet.curves)
      for (const one of curve.cases) {
        const cells = stability.cells(one, contact), marks = cells.filter((cell) => cell.disagrees && cell.unstable).map((cell) => ({ value: [cell.step, 0.95], mark: "✕", text: cell.reason }));
        if (!cells.length) continue;
        const items = cells.map((cell) => {
          const value = heightOf(height, cell);
          if (value === null) return { value: [cell.step, "-"] };
          return Object.assign({ value: [cell.step, value], text: pointText(cell) }, cell.marginal ? { itemStyle: ricochet.hollow(curve.colour) } : {});
        });
        if (grows && items.every((item) => item.value[1] === "-")) flat.push(curve.name);
        series.push(ricochet.curve(curve.name, curve.colour, curve.style, items, 7, 1.4));
        if (marks.length) series.push(Object.assign(ricochet.marks(curve.name, curve.colour, marks), { yAxisIndex: 1 }));
      }
    if (flat.length) out.notes.push("No growth at any step: " + flat.join("; ") + ".");
    return out;
  }

  ricochet.figure("spectral-radius", (data) => {
    const stability = ricochet.stability(data), charts = [], legend = new Map();
    if (stability.steps.empty) return [];
    let caption = "";
    for (const contact of ["open", "closed"]) {
      const cases = stability.cases(contact);
      if (!cases.length) continue;
      const curves = new ricochet.MethodCurves(data.view, cases, "step", [], contact === "closed" ? [] : data.view.varying.filter((column) => ricochet.roleOf(column) === "contact"));
      for (const entry of curves.legend()) if (!legend.has(entry.name)) legend.set(entry.name, entry);
      caption = curves.colours() + " Closed: the worst of several sets of points held on both sides. Hollow: marginal roots. ✕: observed unstable where the spectrum is not.";
      const ranges = heights.map((height) => new Interval().include(...cases.flatMap((one) => stability.cells(one, contact).map((cell) => heightOf(height, cell)).filter((value) => value !== null))));
      for (const facet of curves.facets)
        charts.push({
          title: contact + (facet.title === "all cases" ? "" : " · " + facet.title), views: heights.map((height, k) => chart(stability, height, facet, contact, ranges[k])),
          notes: data.view.outcomeNotes(facet.cases, curves.said),
        });
    }
    return [{ id: "spectral-radius", title: "Spectral radius of one step", caption, views: heights.map((height) => height.name), charts, legend: Array.from(legend.values()) }];
  });
}
