// An orbit of a branch beside the page: what was found of it, its motion, its multipliers, and the special point that
// it is.
{
  const circle = {re: [], im: []}, stopColour = "#777777", pushColour = "#111111", mostRuns = 40, aspect = 4 / 3,
        tip = ["tip displacement", "m"];
  for (let k = 0; k <= 120; ++k) {
    circle.re.push(Math.cos((2 * Math.PI * k) / 120));
    circle.im.push(Math.sin((2 * Math.PI * k) / 120));
  }

  function neighbour(branches, id, row, step) {
    const of = branches.column(id, "of");
    return of[row + step] === of[row] ? row + step : undefined;
  }
  function stability(unstable) {
    return !Number.isFinite(unstable) ? "not known" :
        unstable > 0                  ? "unstable, by " + ricochet.format.count(unstable, "multiplier", "multipliers") :
                                        "stable";
  }
  function facts(branches, id, row) {
    const {shown, exact} = ricochet.format, branch = branches.branch(id, row), number = (name, digits = 8) => {
      const value = branches.column(id, name)[row];
      return Number.isFinite(value) ? shown(value, digits) : null;
    };
    const out = [
      ["branch", branch.name], ["orbit", (branch.symmetric ? "symmetric, " : "") + "period " + branch.period],
      ["stability", stability(branches.column(id, "unstable")[row])], ["arc (m)", number("arc")],
      ["tip displacement (m)", number("tip", 9)], ["tip velocity (m/s)", number("velocity", 6)],
      ["impacts per period", number("impacts", 3)], ["contact runs", number("runs", 3)],
      ["residual (m)", number("residual", 2)]
    ];
    const special = branches.special(id).find(
        (one) => one.branch === branch.name && one.point === branches.column(id, "point")[row]);
    if (special) {
      out.unshift([branches.kindWords(branches.kind(special))[0], exact(special.parameter)]);
      for (const [name, text] of [
               ["name", "name"], ["low", "from"], ["high", "to"], ["crossings", "raw crossings"],
               ["prominence", "prominence"], ["angle", "angle (rad)"], ["contact_phase", "phase of the contact (rad)"],
               ["contact_x", "place of the contact (m)"], ["to_branch", "branch that begins here"], ["note", "note"]])
        if (special[name] !== null && special[name] !== undefined && special[name] !== "")
          out.push([text, typeof special[name] === "number" ? shown(special[name], 9) : special[name]]);
    }
    return out.filter(([, value]) => value !== null);
  }

  // Its motion over a period: against the velocity, and over the phase with the runs of contact at their stops.
  function showMotion(branches, id, row, colour) {
    const {sidePanel} = ricochet, {shown} = ricochet.format, motion = branches.portrait(id, row);
    if (!motion) {
      const own = branches.column(id, "of"),
            near = Array.from(branches.portrayed(id).keys())
                       .filter((other) => own[other] === own[row])
                       .sort((a, b) => Math.abs(a - row) - Math.abs(b - row))[0];
      sidePanel.say("The page carries no portrait of this orbit; the command below solves it again.");
      if (near !== undefined)
        sidePanel.panel().appendChild(sidePanel.button(
            "the nearest orbit that has one", "show the nearest orbit that has a portrait",
            () => show(branches, id, near, colour)));
      return;
    }
    const line = (rows, x, y, more) => ({...ricochet.line("motion", colour, 1.4), rows, x, y, ...more}),
          grey = {silent: true, colour: stopColour, width: 1.2, dash: [4, 3]};
    const fastest = Math.max(...motion.v.map(Math.abs)), stops = [motion.lower, motion.upper].filter(Number.isFinite);
    const strobe = {
      ...ricochet.dot("strobe", "#111111", "circle", 6),
      rows: {u: motion.u.slice(0, 1), v: motion.v.slice(0, 1)},
      x: "u",
      y: "v"
    };
    sidePanel.plot(
        tip, ["tip velocity", "m/s"],
        [
          line(motion, "u", "v"), strobe,
          ...stops.map((at) => line({u: [at, at], v: [-fastest, fastest]}, "u", "v", grey))
        ],
        "portrait");
    sidePanel.say(
        "Dot: the strobe." + (stops.length ? " Dashed: stops of the tip." : "") +
        (branches.branch(id, row).symmetric ? " The orbit is its own image half a period later." : ""));
    // A run over the strobe is drawn in two parts.
    const parts = motion.runs.flatMap((run) => {
      const end = run.begin + run.length;
      return end > motion.period ? [{...run, to: motion.period}, {...run, begin: 0, to: end - motion.period}] :
                                   [{...run, to: end}];
    });
    sidePanel.plot(
        ["phase", "forcing periods"], tip,
        [
          line(motion, "phase", "u"),
          ...parts.map(
              (run) => line(
                  {phase: [run.begin, run.to], u: [run.bound, run.bound]}, "phase", "u",
                  {colour: pushColour, width: 6, z: 3}))
        ],
        "in-time");
    if (!motion.runs.length) {
      sidePanel.say("No stop pushes.");
      return;
    }
    sidePanel.say("Bars: a stop pushes, at its place.");
    const turn = 2 * Math.PI, several = ricochet.distinct(motion.runs.map(({x}) => x)).length > 1;
    const rows =
        motion.runs.slice(0, mostRuns)
            .map(
                (run) =>
                    [run.upper ? "upper" : "lower", ...(several ? [shown(run.x, 5)] : []), shown(turn * run.begin, 5),
                     shown(turn * ((run.begin + run.length) % motion.period), 5), shown(turn * run.length, 4)]);
    sidePanel.heading("Contact runs");
    sidePanel.table(
        [
          ["stop", false], ...(several ? [["x (m)", true]] : []), ["from (rad)", true], ["to (rad)", true],
          ["length (rad)", true]
        ],
        rows);
    if (motion.runs.length > mostRuns) sidePanel.say("The first " + mostRuns + " of " + motion.runs.length + " runs.");
  }

  // Multipliers beside the unit circle, which is round in the panel.
  function showMultipliers(branches, id, row, colour) {
    const {sidePanel} = ricochet, own = branches.multipliers(id, row), smooth = branches.smooth(id, row);
    if (!own.length) return;
    const reach = 1.1 * Math.max(1, ...own.concat(smooth).flatMap(({re, im}) => [Math.abs(re), Math.abs(im)]));
    const dots = (list, name, colour, size, more) =>
              ({...ricochet.dot(name, colour, "circle", size), rows: list, x: "re", y: "im", ...more}),
          corner = {re: aspect * reach, im: reach};
    sidePanel.plot(
        ["real part", "1"], ["imaginary part", "1"],
        [
          {...ricochet.line("unit circle", ricochet.faint, 1), rows: circle, x: "re", y: "im", silent: true},
          dots([corner, {re: -corner.re, im: -corner.im}], "frame", "transparent", 0.01, {silent: true}),
          dots(own, "multiplier", colour, 8),
          ...(smooth.length ? [dots(smooth, "half-step rule", "#111111", 12, {hollow: true, clear: true})] : []),
        ],
        "portrait");
    sidePanel.say(
        "Multipliers of " + (branches.branch(id, row).symmetric ? "half a period" : "the period") +
        ", and the unit circle." +
        (smooth.length ? " Rings: by the half-step rule, the real one nearest −1 and the pair nearest the circle." :
                         ""));
  }

  function show(branches, id, row, colour) {
    const {sidePanel} = ricochet, {shown, unit} = ricochet.format, one = branches.data.byId.get(id),
          branch = branches.branch(id, row);
    const keys = [["‹", "previous orbit", -1], ["›", "next orbit", 1]].map(([text, label, step]) => {
      const next = neighbour(branches, id, row, step), key = sidePanel.button(text, label, () => {
        show(branches, id, next, colour);
        sidePanel.panel().focus();
      });
      key.disabled = next === undefined;
      return key;
    });
    sidePanel.open(
        {id, orbit: row}, "The chosen orbit", colour,
        branches.parameter[0] + " = " + shown(branches.column(id, "parameter")[row], 9) + unit(branches.parameter),
        keys);
    sidePanel.say(branches.label(one));
    sidePanel.list(facts(branches, id, row));
    // A film of this orbit, where the last one that was kept is.
    if (ricochet.film && ricochet.film.has(id) && branches.filmed(id, branch.name, branches.column(id, "arc")[row]))
      sidePanel.panel().appendChild(
          sidePanel.button("▶ see it move", "show the film of this orbit", () => ricochet.film.choose(id)));
    showMotion(branches, id, row, colour);
    showMultipliers(branches, id, row, colour);
    const command = sidePanel.commandOf(branches.data.study.name, id) + " --branch " + sidePanel.quoted(branch.name) +
        " --arc " + branches.column(id, "arc")[row];
    sidePanel.say("This orbit again, step by step as a file; any other arc of its branch is solved as well:");
    sidePanel.command(command);
    sidePanel.say("Its film, for the next report:");
    sidePanel.command(command + " --snapshots 200");
  }

  ricochet.showBranchOrbit = show;
}
