// An orbit beside the page: its portrait, its motion in time, what was found of it, and the command that marches it
// again.
{
  const names = {
    class: "class",
    period: "period",
    symmetric: "symmetric under x → −x, t → t + T/2",
    impacts_per_period: "impacts per period",
    exponent_method: "exponents by",
    exponent_twin: "exponent by twin trajectories (1/s)",
    marginal: "set apart",
    attractor: "attractor",
    alpha_equivalent: "equivalent viscosity (s)",
    recurrence: "recurrence distance",
    contraction: "contraction per period",
    zero_one: "0–1 test",
    transient_periods: "periods before the section",
    settled: "settled",
    chatter: "chatter",
    sticking: "share of time in contact",
    evidence: "evidence",
    status: "status",
    reason: "reason",
  };
  function facts(orbits, id, o) {
    const out = [];
    for (const [name, column] of Object.entries(orbits.of(id).columns)) {
      const value = column[o], exponent = /^exponent_(\d+)$/.exec(name);
      if (value === null || value === "" || name === "parameter" || name === "start" || /_(low|high)$/.test(name))
        continue;
      if (exponent) out.push(["exponent " + exponent[1], orbits.interval(id, name, o)]);
      else
        out.push([
          names[name] || ricochet.format.spaced(name),
          typeof value === "number" ? ricochet.format.shown(value, 8) :
              value === true        ? "yes" :
              value === false       ? "no" :
                                      String(value)
        ]);
    }
    return out;
  }
  // Columns of a table of numbers in the rows of an orbit.
  function columnsOf(orbits, id, table, names, o) {
    const orbit = Array.from(orbits.block(id, table + "/orbit") || []),
          rows = orbit.map((_, i) => i).filter((i) => orbit[i] === o);
    return Object.fromEntries(names.map((name) => {
      const block = orbits.block(id, table + "/" + name);
      return [name, rows.map((i) => block[i])];
    }));
  }
  // The orbit of the same start at the next value of the parameter; undefined at the end.
  function neighbour(orbits, id, o, step) {
    const {start, parameter} = orbits.of(id).columns;
    const list =
        start.map((_, k) => k).filter((k) => start[k] === start[o]).sort((a, b) => parameter[a] - parameter[b]);
    return list[list.indexOf(o) + step];
  }

  function show(orbits, id, o) {
    const {sidePanel} = ricochet, one = orbits.of(id), colour = orbits.groups[one.group[o]][1],
          {unit} = ricochet.format;
    const keys = [["‹", "previous value", -1], ["›", "next value", 1]].map(([text, label, step]) => {
      const next = neighbour(orbits, id, o, step), key = sidePanel.button(text, label, () => {
        show(orbits, id, next);
        sidePanel.panel().focus();
      });
      key.disabled = next === undefined;
      return key;
    });
    sidePanel.open(
        {id, orbit: o}, "The chosen orbit", colour,
        orbits.parameter[0] + " = " + one.columns.parameter[o] + unit(orbits.parameter), keys);
    const label = orbits.label(id),
          partial = orbits.data.byId.get(id).partial ? " · partial: this case is still being worked on" : "";
    sidePanel.say(
        (label ? label + " · " : "") + "start " + orbits.cell(id, "start", o) + " · " + orbits.regime(id, o) + partial);
    const motion = columnsOf(orbits, id, "portrait", ["u", "v", "t"], o),
          section = columnsOf(orbits, id, "points", ["u", "v"], o), moves = motion.u.length > 0,
          dotted = section.u.length > 0;
    const line = (x, y) => ({...ricochet.line("motion", colour, 1.3), rows: motion, x, y});
    const dots = {...ricochet.dot("section", "#111111", "circle", 5), rows: section, x: "u", y: "v"},
          u = ["tip displacement", "m"], v = ["tip velocity", "m/s"];
    if (moves || dotted)
      sidePanel.plot(u, v, [...(moves ? [line("u", "v")] : []), ...(dotted ? [dots] : [])], "portrait");
    if (moves) sidePanel.plot(["time from the strobe", "s"], u, [line("t", "u")], "in-time");
    else
      sidePanel.say(
          (dotted ? "Dots: the section. " : "") +
          "No portrait is stored for this value and start; the command below marches it again.");
    if (moves && dotted) sidePanel.say("Dots: the section.");
    sidePanel.list(facts(orbits, id, o));
    sidePanel.say("The same point again:");
    sidePanel.command(
        sidePanel.commandOf(orbits.data.study.name, id) + " --parameter " + one.columns.parameter[o] + " --start " +
        sidePanel.quoted(String(orbits.cell(id, "start", o))));
  }

  ricochet.showOrbit = show;
}
