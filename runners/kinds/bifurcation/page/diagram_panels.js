// The series of one chart of the bifurcation diagram: points, exponents, the regime of each start, verdicts, and marks on its edges.
{
  const failed = 10;   // of the groups of regimes: what did not finish
  const verdicts = [["robust", "#8CC9A6"], ["depends", "#F2A65A"], ["undecided", "#DADADA"]];
  const dark = "#222222";

  // Every combination of case, regime and kind of start that a panel shows: `make` gets {id, group, kind, tags, name, colour}.
  function each(diagram, panel, make) {
    const { orbits } = diagram;
    for (const one of panel.cases)
      for (let group = 0; group < failed; ++group)
        for (let kind = 0; kind < orbits.kinds.length; ++kind) {
          if ((panel.kind !== undefined && panel.kind !== kind) || !orbits.chosen(one.id, group, kind).length) continue;
          const tags = [orbits.groups[group][0], orbits.kinds[kind][0]];
          if (panel.byMethod) tags.push(diagram.methodName(one));
          make({ id: one.id, group, kind, tags, colour: panel.byMethod ? diagram.colourOf(one) : orbits.groups[group][1] });
        }
  }

  // Sources of the picture of points.
  function points(diagram, panel) {
    const { orbits } = diagram, out = [];
    each(diagram, panel, ({ id, group, kind, tags, colour }) => {
      const built = orbits.points(id, group, kind);
      out.push(Object.assign({ what: "points", id, group, grid: 0, axis: 0, tags, colour, z: group <= 6 ? 3 : 2, glyph: ricochet.handDrawn.cloudGlyph(orbits.kinds[kind][1], built.orbits.length) }, built));
    });
    return out;
  }
  // Sources of the picture of exponents: intervals, largest exponents, further ones, and those of twin trajectories.
  function exponents(diagram, panel, grid, axis) {
    const { orbits } = diagram, out = [], add = (what, more, built) => out.push(Object.assign({ what, grid, axis }, more, built));
    each(diagram, panel, ({ id, group, kind, tags, colour }) => add("whiskers", { id, tags, z: 2, colour: ricochet.lighten(colour, 0.35), glyph: { shape: "whisker", size: 1 } }, orbits.intervals(id, group, kind, "exponent_1")));
    each(diagram, panel, ({ id, group, kind, tags, colour }) => add("exponents", { id, tags, z: 3, colour, glyph: { shape: orbits.kinds[kind][1], size: 4 } }, orbits.column(id, group, kind, "exponent_1")));
    for (let k = 2; k <= diagram.mostExponents; ++k)
      each(diagram, panel, ({ id, group, kind, tags, colour }) => add("further exponents", { id, tags: tags.concat(["further exponents"]), z: 2, colour, glyph: { shape: "circle", size: 3 } }, orbits.column(id, group, kind, "exponent_" + k)));
    if (diagram.twins)
      each(diagram, panel, ({ id, group, kind, tags }) => add("twins", { id, tags: tags.concat(["twin check"]), z: 2, colour: "#8a8a8a", glyph: { shape: "cross", size: 5 } }, orbits.column(id, group, kind, "exponent_twin")));
    return out;
  }
  const zeroLine = (grid, axis, x) => ({ type: "line", name: "zero", symbol: "none", silent: true, z: 1, color: ricochet.faint, xAxisIndex: grid, yAxisIndex: axis, lineStyle: { color: "#555555", width: 1, type: "solid" }, data: [[x.min, 0], [x.max, 0]] });

  function drawCell(params, api) {
    const low = api.coord([api.value(0), api.value(2)]), high = api.coord([api.value(1), api.value(2)]), tall = api.size([0, 1])[1], frame = params.coordSys;
    const left = Math.max(low[0], frame.x), right = Math.min(high[0], frame.x + frame.width);
    if (right <= left) return null;
    // Whole pixels, so that neighbours of one colour leave no seam and the narrowest cell is seen.
    const from = Math.floor(left), to = Math.max(Math.floor(right), from + 1);
    return { type: "rect", shape: { x: from, y: low[1] - tall / 2 + 0.5, width: to - from, height: Math.max(tall - 1, 1) }, style: { fill: api.visual("color") } };
  }
  // Cells of one colour in a band under the diagram; items give their ends along x and their row.
  const bandSeries = (name, tag, colour, grid, axis, data) => ({ type: "custom", name, tags: [tag], xAxisIndex: grid, yAxisIndex: axis, renderItem: drawCell, encode: { x: [0, 1], y: 2 }, clip: true, progressive: 0, itemStyle: { color: colour }, data });
  function regimes(diagram, lanes, grid, axis) {
    const { orbits } = diagram, out = [];
    orbits.groups.forEach(([name, colour], group) => {
      const items = lanes.flatMap((lane, row) => {
        const one = orbits.of(lane.id);
        return orbits.chosen(lane.id, group).filter((o) => one.columns.start[o] === lane.start).map((o) => ({ value: [one.from[o], one.to[o], row], id: lane.id, orbit: o }));
      });
      if (items.length) out.push(bandSeries("regime " + name, name, colour, grid, axis, items));
    });
    return out;
  }
  function verdictBand(diagram, grid, axis) {
    return verdicts.map(([word, colour]) => {
      const items = diagram.verdicts.filter((row) => row.verdict === word).map((row) => ({ value: [row.from, row.to, 0], text: row.sentence || word + (row.choice ? ": " + row.choice : "") }));
      return items.length ? bandSeries(word, word, colour, grid, axis, items) : null;
    }).filter(Boolean);
  }

  // What did not finish, on the axis; located changes, along the upper edge.
  function edgeMarks(diagram, panel) {
    const { orbits, data } = diagram, out = [], { exact, mark } = ricochet.format;
    for (const one of panel.cases) {
      const name = diagram.methodName(one), own = panel.byMethod ? [name] : [];
      const items = orbits.chosen(one.id, undefined, panel.kind).filter((o) => orbits.of(one.id).group[o] === failed && diagram.unfinished(one.id, o)).map((o) => {
        const status = orbits.cell(one.id, "status", o);
        return { value: [orbits.of(one.id).columns.parameter[o], 0.03], mark: mark(status), text: status + ": " + (orbits.cell(one.id, "reason", o) || "no reason given"), id: one.id, orbit: o };
      });
      if (items.length) {
        const series = Object.assign(ricochet.marks("not finished", dark, items), { tags: [orbits.groups[failed][0]].concat(own), yAxisIndex: 1 });
        series.label.fontSize = 11;
        out.push(series);
      }
      const changes = data.ownRows("bifurcations", one.id).filter((row) => row.value !== null && (panel.kind === undefined || orbits.kindOfStart(row.start) === panel.kind)).map((row) => {
        const between = row.low !== null && row.high !== null ? ", between " + exact(row.low) + " and " + exact(row.high) : "";
        return { value: [row.value, 0.97], text: row.kind + ": " + row.from + " → " + row.to + ", start " + row.start + between };
      });
      const colour = panel.byMethod ? diagram.colourOf(one) : dark;
      if (changes.length)
        out.push({ type: "scatter", name: panel.byMethod ? "located change, " + name : "located change", tags: ["located change"].concat(own), symbol: "triangle", symbolRotate: 180, symbolSize: 7, z: 5, yAxisIndex: 1, color: colour, itemStyle: { color: colour }, data: changes });
    }
    return out;
  }

  ricochet.diagramPanels = { points, exponents, zeroLine, regimes, verdictBand, edgeMarks, verdicts, dark };
}
