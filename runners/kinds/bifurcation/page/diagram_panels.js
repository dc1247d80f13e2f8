// What one chart of the bifurcation diagram shows: points, exponents, the regime of each start, verdicts, and marks on
// its edges.
{
  const failed = 11;  // of the groups of regimes: what did not finish
  const verdicts = [["robust", "#8CC9A6"], ["depends", "#F2A65A"], ["undecided", "#DADADA"]];
  const dark = "#222222";

  // Marks for every combination of case, regime and kind of start that a panel shows: `make` gets {id, group, kind,
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

  // Starts are told apart by their symbols while points are few; clouds are dots. {symbol, size}.
  const cloud = (symbol, count) =>
      (count > 2500 ? {symbol: "dot", size: count > 40000 ? 1.5 : 2} : {symbol, size: count < 400 ? 6 : 5});
  const points = (diagram, panel) => each(diagram, panel, ({kind, ...own}) => {
    const built = diagram.orbits.points(own.id, own.group, kind),
          look = cloud(diagram.orbits.kinds[kind][1], built.orbits.length);
    return {mark: "dots", name: own.tags[0], what: "points", ...own, z: own.group <= 6 ? 3 : 2, ...look, ...built};
  });
  // Intervals, largest exponents, further ones, and those of twin trajectories.
  function exponents(diagram, panel, yAxis) {
    const {orbits} = diagram;
    const marks = (what, columns, style, tag) =>
        each(diagram, panel, (own) => ({
                               mark: "dots",
                               what,
                               yAxis,
                               id: own.id,
                               name: own.tags[0],
                               tags: own.tags.concat(tag || []),
                               colour: own.colour,
                               ...style(own),
                               ...orbits.columns(own.id, own.group, own.kind, columns),
                             }));
    const out = [
      ...marks(
          "whiskers", ["exponent_1_low", "exponent_1_high"],
          ({colour}) => ({mark: "whiskers", silent: true, colour: ricochet.lighten(colour, 0.35)})),
      ...marks("exponents", ["exponent_1"], ({kind}) => ({z: 3, symbol: orbits.kinds[kind][1], size: 4})),
    ];
    for (let k = 2; k <= diagram.mostExponents; ++k)
      out.push(
          ...marks("further exponents", ["exponent_" + k], () => ({symbol: "circle", size: 3}), "further exponents"));
    return diagram.twins ?
        out.concat(
            marks("twins", ["exponent_twin"], () => ({colour: "#8a8a8a", symbol: "cross", size: 5}), "twin check")) :
        out;
  }
  // Cells {from, to, row} of a band under the diagram, those of one colour.
  const drawBand = (view, rows, name, tag, colour, yAxis, only) =>
      ricochet.draw(view, rows, {x: ["from", "to"], y: "row"}, {mark: "cells", name, tags: [tag], yAxis, colour}, only);
  function regimes(diagram, view, lanes, axis) {
    const {orbits} = diagram, rows = lanes.flatMap(({id, start}, row) => {
      const {columns, from, to, group} = orbits.of(id),
                                own = orbits.chosen(id).filter((o) => columns.start[o] === start);
      return own.map((o) => ({from: from[o], to: to[o], row, group: group[o], id, orbit: o}));
    });
    orbits.groups.forEach(
        ([name, colour], group) => drawBand(view, rows, "regime " + name, name, colour, axis, {group}));
  }
  function verdictBand(diagram, view, axis) {
    const rows = diagram.verdicts.map(
        (row) => ({...row, row: 0, text: row.sentence || row.verdict + (row.choice ? ": " + row.choice : "")}));
    for (const [verdict, colour] of verdicts) drawBand(view, rows, verdict, verdict, colour, axis, {verdict});
  }

  // What did not finish, marks in a strip.
  const unfinished = (diagram, {cases, byMethod, kind}, {orbits} = diagram) =>
      cases.map((one) => ({
                  tags: [orbits.groups[failed][0]].concat(byMethod ? [diagram.methodName(one)] : []),
                  rows: orbits.chosen(one.id, failed, kind).filter((o) => diagram.unfinished(one.id, o)).map((o) => {
                    const status = orbits.cell(one.id, "status", o);
                    return {
                      at: orbits.cell(one.id, "parameter", o),
                      height: 0,
                      mark: ricochet.format.mark(status),
                      text: status + ": " + (orbits.cell(one.id, "reason", o) || "no reason given"),
                      id: one.id,
                      orbit: o
                    };
                  })
                }));
  // Located changes, along the upper edge.
  function changeMarks(diagram, view, panel) {
    const {orbits, data} = diagram, {exact} = ricochet.format;
    for (const one of panel.cases) {
      const name = diagram.methodName(one), own = panel.byMethod ? [name] : [],
            colour = panel.byMethod ? diagram.colourOf(one) : dark;
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
          mark: "dots",
          name: panel.byMethod ? "located change, " + name : "located change",
          tags: ["located change"].concat(own),
          symbol: "triangle-down",
          size: 7,
          z: 5,
          yAxis: 1,
          apart: false,
          colour,
        });
    }
  }

  ricochet.diagramPanels = {points, exponents, regimes, verdictBand, unfinished, changeMarks, verdicts, dark};
}
