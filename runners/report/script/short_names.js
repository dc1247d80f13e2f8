// Short names of what labels say often, one table for the whole page: the full name stands in the tooltip and in a key below the figure.
{
  const names = [
    ["newmark-dumont-paoli", "NDP"], ["moreau-jean", "MJ"], ["structure.damping.stiffness", "α"], ["structure.damping.mass", "η"], ["support.amplitude", "A₀"], ["support.pulsation", "ω"],
    ["contact.stiffness", "κ"], ["contact.restitution", "e"], ["time.restitution", "e"], ["stiffness", "κ"], ["restitution", "e"], ["elements", "N"], ["step", "h"],
    ["time.beta", "β"], ["time.gamma", "γ"], ["time.theta", "θ"], ["beta", "β"], ["gamma", "γ"], ["theta", "θ"],
  ];
  const meanings = {
    NDP: "newmark-dumont-paoli", MJ: "moreau-jean", "α": "structure.damping.stiffness (C = αK + ηM)", "η": "structure.damping.mass (C = αK + ηM)", "A₀": "support.amplitude", "ω": "support.pulsation",
    "κ": "stiffness of the contact", e: "restitution", N: "elements", h: "step", "β": "beta", "γ": "gamma", "θ": "theta",
  };
  // A word of everyday language is a name where a value or another choice follows it.
  const named = (full) => full.replace(/\./g, "\\.") + (/^[a-z]+$/.test(full) ? "(?=$|[,)]| ×| ·| \\([^)]{1,6}\\)| [\\d−])" : "");
  const short = new Map(names), whole = new RegExp("(?<![\\w.-])(?:" + names.map(([full]) => named(full)).join("|") + ")(?![\\w-]|\\.\\w)", "g");

  // A label with short names; `used`, where given, takes those that it has.
  ricochet.shorten = (label, used) => String(label).replace(whole, (full) => {
    const found = short.get(full);
    if (used) used.add(found);
    return found;
  });
  // What short names mean: "α structure.damping.stiffness · N elements".
  ricochet.keyTo = (used) => Array.from(used, (name) => name + " " + meanings[name]).join(" · ");
}
