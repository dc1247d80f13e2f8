// What one chart of the bifurcation diagram shows: points, exponents, the regime of each start, verdicts, and marks on
// its edges. Points and exponents are drawn by hand, from blocks of numbers; the others are series of the library, from
// tables.
{
  const failed = 11;  // of the groups of regimes: what did not finish
  const verdicts = [["robust", "#8CC9A6"], ["depends", "#F2A65A"], ["undecided", "#DADADA"]];
  const dark = "#222222";

  // Sources for every combination of case, regime and kind of start that a panel shows: `make` gets {id, group, kind,
  // tags, colour}.
  function each(diagram, panel, make) {
    const {orbits} = diagram, out = [];
    for (const one of panel.cases)
      for (let group = 0; group < failed; ++group)
        for (let kind = 0; kind < orbits.kinds.length; ++kind) {
          if ((panel.kind !== undefined && panel.kind !== kind) || !orbits.chosen(one.id, group, kind).length) continue;
          const tags =
              [orbits.groups[group][0], orbits.kinds[kind][0]].concat(panel.byMethod ? [diagram.methodName(one)] : []);
          out.push(make({
            id: one.id,
            group,
            kind,
            tags,
            colour: panel.byMethod ? diagram.colourOf(one) : orbits.groups[group][1]
          }));
        }
    return out;
  }

  // Sources of the picture of points.
  const points = (diagram, panel) => each(diagram, panel, ({kind, ...own}) => {
    const built = diagram.orbits.points(own.id, own.group, kind),
          glyph = ricochet.handDrawn.cloudGlyph(diagram.orbits.kinds[kind][1], built.orbits.length);
    return {what: "points", ...own, grid: 0, axis: 0, z: own.group <= 6 ? 3 : 2, glyph, ...built};
  });
  // Sources of the picture of exponents: intervals, largest exponents, further ones, and those of twin trajectories.
  function exponents(diagram, panel, grid, axis) {
    const {orbits} = diagram;
    const sources = (what, columns, style, tag) =>
        each(diagram, panel, (own) => ({
                               what,
                               grid,
                               axis,
                               id: own.id,
                               tags: own.tags.concat(tag || []),
                               z: 2,
                               colour: own.colour,
                               ...style(own),
                               ...orbits.columns(own.id, own.group, own.kind, columns),
                             }));
    const out = [
      ...sources(
          "whiskers", ["exponent_1_low", "exponent_1_high"],
          ({colour}) => ({colour: ricochet.lighten(colour, 0.35), glyph: {shape: "whisker"}})),
      ...sources("exponents", ["exponent_1"], ({kind}) => ({z: 3, glyph: {shape: orbits.kinds[kind][1], size: 4}})),
    ];
    for (let k = 2; k <= diagram.mostExponents; ++k)
      out.push(...sources(
          "further exponents", ["exponent_" + k], () => ({glyph: {shape: "circle", size: 3}}), "further exponents"));
    return diagram.twins ?
        out.concat(sources(
            "twins", ["exponent_twin"], () => ({colour: "#8a8a8a", glyph: {shape: "cross", size: 5}}), "twin check")) :
        out;
  }
  function zeroLine(diagram, view, grid, axis) {
    const {min, max} = view.option.xAxis[0];
    ricochet.draw(view, [min, max].map((parameter) => ({parameter, value: 0})), {x: "parameter", y: "value"}, {
      ...ricochet.line("zero", ricochet.faint, 1),
      lineStyle: {color: "#555555", width: 1},
      silent: true,
      xAxisIndex: grid,
      yAxisIndex: axis
    });
  }

  function drawCell(params, api) {
    const low = api.coord([api.value("from"), api.value("row")]), high = api.coord([api.value("to"), api.value("row")]),
          tall = api.size([0, 1])[1], frame = params.coordSys;
    const left = Math.max(low[0], frame.x), right = Math.min(high[0], frame.x + frame.width);
    if (right <= left) return null;
    // Whole pixels, so that neighbours of one colour leave no seam and the narrowest cell is seen.
    const from = Math.floor(left), to = Math.max(Math.floor(right), from + 1);
    return {
      type: "rect",
      shape: {x: from, y: low[1] - tall / 2 + 0.5, width: to - from, height: Math.max(tall - 1, 1)},
      style: {fill: api.visual("color")}
    };
  }
  // Cells {from, to, row} of a band under the diagram, those of one colour.
  function drawBand(view, rows, name, tag, colour, grid, axis, only) {
    const style = {
      type: "custom",
      name,
      tags: [tag],
      xAxisIndex: grid,
      yAxisIndex: axis,
      renderItem: drawCell,
      clip: true,
      progressive: 0,
      itemStyle: {color: colour}
    };
    ricochet.draw(view, rows, {x: ["from", "to"], y: "row"}, style, only);
  }
  function regimes(diagram, view, lanes, grid, axis) {
    const {orbits} = diagram, rows = lanes.flatMap(({id, start}, row) => {
      const {columns, from, to, group} = orbits.of(id),
                                own = orbits.chosen(id).filter((o) => columns.start[o] === start);
      return own.map((o) => ({from: from[o], to: to[o], row, group: group[o], id, orbit: o}));
    });
    orbits.groups.forEach(
        ([name, colour], group) => drawBand(view, rows, "regime " + name, name, colour, grid, axis, {group}));
  }
  function verdictBand(diagram, view, grid, axis) {
    const rows = diagram.verdicts.map(
        (row) => ({...row, row: 0, text: row.sentence || row.verdict + (row.choice ? ": " + row.choice : "")}));
    for (const [verdict, colour] of verdicts) drawBand(view, rows, verdict, verdict, colour, grid, axis, {verdict});
  }

  // What did not finish, on the axis; located changes, along the upper edge.
  function edgeMarks(diagram, view, panel) {
    const {orbits, data} = diagram, {exact, mark} = ricochet.format;
    for (const one of panel.cases) {
      const name = diagram.methodName(one), own = panel.byMethod ? [name] : [],
            colour = panel.byMethod ? diagram.colourOf(one) : dark;
      const unfinished =
          orbits.chosen(one.id, failed, panel.kind).filter((o) => diagram.unfinished(one.id, o)).map((o) => {
            const status = orbits.cell(one.id, "status", o),
                  text = status + ": " + (orbits.cell(one.id, "reason", o) || "no reason given");
            return {
              at: orbits.cell(one.id, "parameter", o),
              height: 0.03,
              mark: mark(status),
              text,
              id: one.id,
              orbit: o
            };
          });
      const style = ricochet.textMark({name: "not finished", colour: dark});
      ricochet.drawMarks(
          view, {name: style.name, colour: dark}, unfinished,
          {tags: [orbits.groups[failed][0]].concat(own), label: {...style.label, fontSize: 11}});
      const found = data.ownRows("bifurcations", one.id)
                        .filter(
                            (row) => row.value !== null &&
                                (panel.kind === undefined || orbits.kindOfStart(row.start) === panel.kind));
      const changes = found.map((row) => {
        const between =
            row.low !== null && row.high !== null ? ", between " + exact(row.low) + " and " + exact(row.high) : "";
        return {
          value: row.value,
          height: 0.97,
          text: row.kind + ": " + row.from + " → " + row.to + ", start " + row.start + between
        };
      });
      if (changes.length)
        ricochet.draw(view, changes, {x: "value", y: "height"}, {
          type: "scatter",
          name: panel.byMethod ? "located change, " + name : "located change",
          tags: ["located change"].concat(own),
          symbol: "triangle",
          symbolRotate: 180,
          symbolSize: 7,
          z: 5,
          yAxisIndex: 1,
          color: colour,
        });
    }
  }

  ricochet.diagramPanels = {points, exponents, zeroLine, regimes, verdictBand, edgeMarks, verdicts, dark};
}
