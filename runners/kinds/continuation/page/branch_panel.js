// An orbit of a branch beside the page: what was found of it, its multipliers, and the special point that it is.
{
  const circle = { x: [], y: [] };
  for (let k = 0; k <= 120; ++k) { circle.x.push(Math.cos((2 * Math.PI * k) / 120)); circle.y.push(Math.sin((2 * Math.PI * k) / 120)); }

  function neighbour(branches, id, row, step) {
    const of = branches.column(id, "of");
    return of[row + step] === of[row] ? row + step : undefined;
  }
  function stability(unstable) {
    return !Number.isFinite(unstable) ? "not known" : unstable > 0 ? "unstable, by " + ricochet.format.count(unstable, "multiplier", "multipliers") : "stable";
  }
  function facts(branches, id, row) {
    const { shown, exact } = ricochet.format, branch = branches.branch(id, row), number = (name, digits = 8) => { const value = branches.column(id, name)[row]; return Number.isFinite(value) ? shown(value, digits) : null; };
    const out = [["branch", branch.name], ["orbit", (branch.symmetric ? "symmetric, " : "") + "period " + branch.period], ["stability", stability(branches.column(id, "unstable")[row])], ["arc (m)", number("arc")],
      ["tip displacement (m)", number("tip", 9)], ["tip velocity (m/s)", number("velocity", 6)], ["impacts per period", number("impacts", 3)], ["contact runs", number("runs", 3)], ["residual (m)", number("residual", 2)]];
    const special = branches.special(id).find((one) => one.branch === branch.name && one.point === branches.column(id, "point")[row]);
    if (special) {
      out.unshift([branches.kindWords(branches.kind(special))[0], exact(special.parameter)]);
      for (const [name, text] of [["name", "name"], ["low", "from"], ["high", "to"], ["crossings", "raw crossings"], ["prominence", "prominence"], ["angle", "angle (rad)"], ["contact_phase", "phase of the contact (rad)"], ["contact_x", "place of the contact (m)"], ["to_branch", "branch that begins here"], ["note", "note"]])
        if (special[name] !== null && special[name] !== undefined && special[name] !== "") out.push([text, typeof special[name] === "number" ? shown(special[name], 9) : special[name]]);
    }
    return out.filter(([, value]) => value !== null);
  }

  function show(branches, id, row, colour) {
    const { sidePanel } = ricochet, { shown, unit } = ricochet.format, one = branches.data.byId.get(id);
    const keys = [["‹", "previous orbit", -1], ["›", "next orbit", 1]].map(([text, label, step]) => {
      const next = neighbour(branches, id, row, step), key = sidePanel.button(text, label, () => { show(branches, id, next, colour); sidePanel.panel().focus(); });
      key.disabled = next === undefined;
      return key;
    });
    sidePanel.open({ id, orbit: row }, "The chosen orbit", colour, branches.parameter[0] + " = " + shown(branches.column(id, "parameter")[row], 9) + unit(branches.parameter), keys);
    sidePanel.say(branches.label(one));
    sidePanel.list(facts(branches, id, row));
    const own = branches.multipliers(id, row), x = own.map(({ re }) => re), y = own.map(({ im }) => im);
    if (own.length) {
      sidePanel.plot("real part", "imaginary part", [
        { source: circle, encode: { x: "x", y: "y" }, type: "line", symbol: "none", silent: true, color: ricochet.faint, lineStyle: { width: 1 } },
        { source: { x, y }, encode: { x: "x", y: "y" }, type: "scatter", symbolSize: 8, color: colour },
      ], "portrait");
      sidePanel.say("Multipliers of " + (branches.branch(id, row).symmetric ? "half a period" : "the period") + ", and the unit circle.");
    }
    sidePanel.say("The same case again:");
    sidePanel.command(sidePanel.commandOf(branches.data.study.name, id, "case"));
  }

  ricochet.showBranchOrbit = show;
}
