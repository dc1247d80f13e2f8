// Spectral radius of one step and its growth against the step: a chart for the open structure, one for closed contact,
// a curve per method.
{
  const {Interval} = ricochet;
  const heights = [
    {name: "spectral radius", column: "radius", above: 0, none: "Nothing is predicted.", frame: [0.1, 10]},
    {name: "growth per step", column: "growth", above: 1e-9, none: "Nothing grows.", frame: [1e-9, 1e-6]}
  ];  // below 1e-9 a radius is one to round-off

  const drawn = (height, cell) => cell[height.column] !== null && cell[height.column] > height.above;
  // A cell that is not drawn interrupts the curve.
  function rowOf(height, cell) {
    const text =
        ["radius " + ricochet.format.text(cell.radius, 9), cell.marginal, cell.reason].filter(Boolean).join("; ");
    return {
      case: cell.case,
      step: cell.step,
      value: drawn(height, cell) ? cell[height.column] : null,
      hollow: Boolean(cell.marginal),
      text
    };
  }

  function chart(stability, height, facet, contact, range) {
    const x = ["step h", "s"], y = [height.name, "1"], grows = height.column === "growth", flat = [];
    let frame = range.empty ? new Interval(...height.frame) : range.copy();
    if (!grows) frame = ricochet.wholeDecades(frame).include(0.1, 10);
    const out = ricochet.view(x, y, ricochet.logAxis(x, stability.steps), ricochet.logAxis(y, frame)),
          [{min, max}] = out.xAxes, disagree = [];
    if (range.empty) out.notes.push(height.none);
    if (!grows)  // |r| = 1
      ricochet.draw(
          out, [min, max].map((step) => ({step, value: 1})), {x: "step", y: "value"},
          {...ricochet.line("unit circle", ricochet.faint, 1), silent: true});
    for (const curve of facet.curves)
      for (const cells of curve.cases.map((one) => stability.cells(one, contact)).filter((list) => list.length)) {
        if (grows && !cells.some((cell) => drawn(height, cell))) flat.push(curve.name);
        const rows = cells.map((cell) => rowOf(height, cell));
        ricochet.draw(out, rows, {x: "step", y: "value"}, ricochet.hollowCurve(curve, rows, 7, 1.4));
        disagree.push([
          curve,
          cells.filter((cell) => cell.disagrees && cell.unstable)
              .map((cell) => ({case: cell.case, at: cell.step, mark: "✕", text: cell.reason}))
        ]);
      }
    ricochet.outcomeStrip(out, disagree, "observed");
    if (flat.length) out.notes.push("No growth at any step: " + flat.join("; ") + ".");
    return out;
  }

  ricochet.figure("spectral-radius", (data) => {
    const stability = ricochet.stability(data), charts = [], legend = [];
    if (stability.steps.empty) return [];
    let caption = "";
    for (const contact of ["open", "closed"]) {
      const cases = stability.cases(contact),
            ignored =
                contact === "closed" ? [] : data.view.varying.filter((column) => ricochet.roleOf(column) === "contact");
      if (!cases.length) continue;
      const curves = new ricochet.MethodCurves(data.view, cases, "step", {ignored}),
            cells = cases.flatMap((one) => stability.cells(one, contact));
      const ranges = heights.map(
          (height) => new Interval().include(
              ...cells.filter((cell) => drawn(height, cell)).map((cell) => cell[height.column])));
      caption = curves.colours() +
          " Closed: the worst of several sets of points held on both sides. Hollow: marginal roots. ✕: observed " +
          "unstable where the spectrum is not.";
      legend.push(...curves.legend());
      for (const one of curves.charts(
               (facet) => heights.map((height, k) => chart(stability, height, facet, contact, ranges[k]))))
        charts.push(
            Object.assign(one, {part: contact, title: contact + (one.title === "all cases" ? "" : " · " + one.title)}));
    }
    return [{
      id: "spectral-radius",
      title: "Spectral radius of one step",
      caption,
      views: heights.map((height) => height.name),
      charts,
      legend: ricochet.firstOfName(legend),
      measured: stability.measured
    }];
  });
}
