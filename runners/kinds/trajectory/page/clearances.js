// Where places are within their clearances: a chart per clearance, both axes on one scale. Each method has a dot per
// sample, at its finest step and mesh.
ricochet.figure("clearances", (data) => {
  const {view} = data, found = data.rows("orbit_points").filter((row) => data.byId.has(row.case));
  if (!found.length) return [];
  const side = 300, around = 1.15, corners = 90;  // pixels, share of the radius, of the circle as it is drawn
  const nameOf = (one) => view.label(one, view.varyingWithout(["step", "elements", "modes"])) || "all cases";
  const cases = ricochet.distinct(found.map((row) => data.byId.get(row.case))).slice(0, ricochet.mostCurves),
        legend = [];
  cases.forEach(
      (one, k) => legend.push(ricochet.swatch(nameOf(one), ricochet.methodColours[k % ricochet.mostCurves], "circle")));
  const charts = ricochet.distinct(found.map((row) => row.stop)).map((stop) => {
    const rows = found.filter((row) => row.stop === stop), radius = rows[0].radius,
          reach = around * Math.max(radius, ...rows.map((row) => Math.max(Math.abs(row.first), Math.abs(row.second))));
    const said = [].concat(data.page.study.resolved?.scene?.stops ?? []).find((one) => one.name === stop),
          [first, second] = said?.clearance?.components ?? ["first component", "second component"];
    const x = [first, "m"], y = [second, "m"], frame = new ricochet.Interval(-reach, reach);
    const across = ricochet.valueAxis(x, frame), up = ricochet.valueAxis(y, frame),
          out = ricochet.view(x, y, across, up);
    out.frames = [{left: 84, top: 14, width: side, height: side}];
    const circle = Array.from({length: corners + 1}, (_, k) => ({
                                                       first: radius * Math.cos(2 * Math.PI * k / corners),
                                                       second: radius * Math.sin(2 * Math.PI * k / corners)
                                                     }));
    ricochet.draw(
        out, circle, {x: "first", y: "second"}, {...ricochet.line("clearance", "#777777", 1.2), silent: true});
    cases.forEach((one, k) => {
      const own = rows.filter((row) => row.case === one.id)
                      .map((row) => ({...row, text: "t = " + ricochet.format.text(row.t, 5) + " s"})),
            colour = ricochet.methodColours[k % ricochet.mostCurves];
      if (own.length)
        ricochet.draw(
            out, own, {x: "first", y: "second"}, {...ricochet.dot(nameOf(one), colour, "circle", 3), opacity: 0.5});
    });
    return {title: stop, views: [out], notes: [], height: side + 62};
  });
  return [{
    id: "clearances",
    title: "Orbits within the clearances",
    views: ["orbit"],
    charts,
    legend,
    caption:
        "A dot per sample over the window, or over the run: the place within its circle, from the axis. Each method " +
        "at its finest step and mesh. All samples: orbits.csv.",
  }];
});
