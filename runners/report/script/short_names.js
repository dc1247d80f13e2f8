// Short names of what labels say often, one table for the whole page. The full name stands in the tooltip and in a key
// below the figure.
{
  const names = [
    ["structure.damping.stiffness", "α"],
    ["structure.damping.mass", "η"],
    ["support.amplitude", "A₀"],
    ["support.pulsation", "ω"],
    ["contact.stiffness", "κ"],
    ["contact.restitution", "e"],
    ["time.restitution", "e"],
    ["stiffness", "κ"],
    ["restitution", "e"],
    ["elements", "N"],
    ["steps_per_period", "steps/T"],
    ["step", "h"],
    ["time.beta", "β"],
    ["time.gamma", "γ"],
    ["time.theta", "θ"],
    ["beta", "β"],
    ["gamma", "γ"],
    ["theta", "θ"],
  ];
  const meanings = {
    "α": "structure.damping.stiffness (C = αK + ηM)",
    "η": "structure.damping.mass (C = αK + ηM)",
    "A₀": "support.amplitude",
    "ω": "support.pulsation",
    "steps/T": "steps_per_period",
    "κ": "stiffness of the law",
    e: "restitution",
    N: "elements",
    h: "step",
    "β": "beta",
    "γ": "gamma",
    "θ": "theta",
  };
  // A word of everyday language is a name where a value or another choice follows it, and no article stands before it.
  const named = (full) =>
      full.replace(/\./g, "\\.") + (/^[a-z]+$/.test(full) ? "(?=$|[,)]| ×| ·| \\([^)]{1,6}\\)| [\\d−])" : "");
  // Methods go by the words that their plugins give: [name, words]; those of mass matrices stay, which are words.
  const methods = (words) => Object.entries(words || {})
                                 .map(([key, said]) => [key.slice(key.indexOf(" ") + 1), said, key])
                                 .filter(([name, said, key]) => name !== said && !key.startsWith("mass "));
  // The names of the page's study; before its data are read those that every study has.
  let known = null;
  function table() {
    if (known && (known.whole || !ricochet.data)) return known;
    const usual = new Set(names.map(([full]) => full)),
          axes = ricochet.data ?
        ricochet.data.page.axes.filter(({name, said}) => said && said !== name && !usual.has(name))
            .map(({name, said}) => [name, said, name]) :
        [];
    const schemes = axes.concat(ricochet.data ? methods(ricochet.data.page.words) : []),
          all = schemes.map(([name, said]) => [name, said]).concat(names);
    known = {
      whole: Boolean(ricochet.data),
      short: new Map(all),
      pattern: new RegExp(
          "(?<![\\w.-])(?<!\\bthe )(?:" +
              schemes.map(([full]) => named(full)).concat(names.map(([full]) => named(full))).join("|") +
              ")(?![\\w-]|\\.\\w)",
          "g")
    };
    for (const [full, brief] of schemes) meanings[brief] = full;
    return known;
  }

  // A label with short names; `used`, where given, takes those that it has.
  ricochet.shorten = (label, used) => {
    const {short, pattern} = table();
    return String(label).replace(pattern, (full) => {
      const found = short.get(full);
      if (used) used.add(found);
      return found;
    });
  };
  // What an axis is called where there is room.
  ricochet.said = (column) => ricochet.data.page.axes.find(({name}) => name === column)?.said || column;
  // What short names mean: "α structure.damping.stiffness · N elements".
  ricochet.keyTo = (used) => Array.from(used, (name) => name + " " + meanings[name]).join(" · ");
}
