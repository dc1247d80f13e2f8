// A case beside the page: what it is, what it measured, and the command that marches it again. Its curves, portrait,
// impacts and energy are shown as far as the page holds them.
{
  const quantities = {
    tip_displacement: ["tip displacement", "m"],
    tip_velocity: ["tip velocity", "m/s"],
    contact_force_peak: ["contact force |p|", "N"],
    energy: ["energy E", "J"],
  };
  const inCurve = ["tip_displacement", "contact_force_peak", "energy"];  // in this order
  const impactColumns = ["t", "x", "side", "speed_in", "speed_out", "impulse", "peak_force", "duration"];
  const mostMeasures = 10;

  const quantityOf = (column) => quantities[column] || [ricochet.format.spaced(column), "1"];
  const number = (value) => ricochet.format.shown(value, 6);

  // What varies first, then what all cases share.
  function parameters(data, one) {
    const {view} = data,
          fact = (column) => [column, one.values[column].text + (view.unit(column) ? " " + view.unit(column) : "")];
    const has = view.columns.filter((column) => one.values[column]);
    return {
      varying: has.filter((column) => view.varies(column)).map(fact),
      fixed: has.filter((column) => !view.varies(column)).map(fact)
    };
  }
  function measures(data, one) {
    const meaning = new Map(data.page.measures.map((column) => [column.name, column]));
    return Object.entries(one.measures)
        .map(([name, value]) => [ricochet.format.spaced(name), number(value) + ricochet.format.unit([
               name, (meaning.get(name) || {unit: "1"}).unit
             ])]);
  }

  function showCurves(data, one) {
    const {sidePanel, format} = ricochet, held = (data.page.curves || {})[one.id] || {}, colour = data.view.colour(one);
    for (const column of inCurve.filter((name) => held[name])) {
      const {x, y} = data.curve(one, column);
      const line = {...ricochet.line(column, colour, 1.3), rows: {t: x, value: y}, x: "t", y: "value", rising: true};
      sidePanel.plot(["t", "s"], quantityOf(column), [line], "in-time");
    }
    const [u, v] = ["tip_displacement", "tip_velocity"].map((column) => data.block(one.id + "/portrait/" + column));
    if (!u || !v) return;
    sidePanel.heading("Phase portrait");
    const portrait = {...ricochet.line("phase portrait", colour, 1), rows: {u, v}, x: "u", y: "v"};
    sidePanel.plot(quantities.tip_displacement, quantities.tip_velocity, [portrait], "portrait");
  }

  function showImpacts(data, one) {
    const {sidePanel, format} = ricochet, total = one.measures.impacts, panel = data.page.panel || {},
                      held = (panel.impacts || {}).columns, rows = held && panel.impacts.cases[one.id];
    if (total === undefined) return;
    sidePanel.heading("Impacts");
    if (total === 0) {
      sidePanel.say("None: no contact point closed.");
      return;
    }
    if (!rows) {
      sidePanel.say(format.count(total, "impact", "impacts") + ", listed in impacts.csv.");
      return;
    }
    const columns = impactColumns.map((name) => held.findIndex((column) => column.name === name)).filter((c) => c >= 0);
    const cell = (value) => (value === null ? "–" : typeof value === "number" ? number(value) : value);
    sidePanel.table(
        columns.map((c) => [format.withUnit([format.spaced(held[c].name), held[c].unit]), held[c].unit !== ""]),
        rows.map((row) => columns.map((c) => cell(row[c]))));
    if (total > rows.length)
      sidePanel.say("The first " + rows.length + " of " + total + "; the rest stand in impacts.csv.");
  }

  function showLedger(data, one) {
    const {sidePanel, format} = ricochet, ledger = (data.page.panel || {}).ledger || {},
                      cells = (ledger.cases || {})[one.id];
    if (!cells) return;
    sidePanel.heading("Where its energy came from and went");
    sidePanel.list(ledger.columns.map(
        (column, c) =>
            [format.spaced(column.name),
             cells[c] === null                ? "–" :
                 typeof cells[c] === "number" ? number(cells[c]) + format.unit([column.name, column.unit]) :
                                                cells[c]]));
  }

  function showCommands(data, one) {
    const {sidePanel} = ricochet, command = sidePanel.commandOf(data.study.name, one.id, "case");
    if (!ricochet.manyOrbits) {
      sidePanel.say("This case again, compared with what is stored:");
      sidePanel.command(command);
    } else {
      sidePanel.say("A case is many orbits: a click on one of them tells how to march it again.");
    }
    sidePanel.say("The study of this case alone:");
    sidePanel.command(command + " --study > one.json");
    if (!ricochet.manyOrbits && ricochet.film && !ricochet.film.has(one.id)) {
      sidePanel.say("Its film, for the next report:");
      sidePanel.command(command + " --snapshots 200");
    }
  }

  function show(data, id) {
    const {sidePanel, format} = ricochet, one = data.byId.get(id), {view} = data;
    if (!one) return;
    const keys = [["‹", "previous case", -1], ["›", "next case", 1]].map(([text, label, step]) => {
      const next = data.cases[one.index + step], key = sidePanel.button(text, label, () => {
        show(data, next.id);
      });
      key.disabled = !next;
      return key;
    });
    const panel = sidePanel.open({id}, "The chosen case", view.colour(one), view.label(one) || "the one case", keys),
          {varying, fixed} = parameters(data, one);
    sidePanel.say(
        "case " + id + " · " + format.mark(one.status) + " " + one.status + (one.reason ? ": " + one.reason : "") +
        (one.partial ? " · partial: still being worked on" : ""));
    sidePanel.list(varying);
    showCurves(data, one);
    if (ricochet.film && ricochet.film.has(id))
      panel.appendChild(
          sidePanel.button("▶ see it move", "show the film of this case", () => ricochet.film.choose(id)));
    const all = measures(data, one);
    if (all.length) {
      sidePanel.heading("Measures");
      sidePanel.list(all.slice(0, mostMeasures));
      if (all.length > mostMeasures)
        sidePanel.more((all.length - mostMeasures) + " more measures", all.slice(mostMeasures));
    }
    showImpacts(data, one);
    showLedger(data, one);
    if (fixed.length) sidePanel.more("The same in every case", fixed);
    showCommands(data, one);
    panel.focus({preventScroll: true});
  }

  ricochet.showCase = show;
}
