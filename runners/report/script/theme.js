// Charts say their colours for white paper. On a dark screen one rule carries each over. Greys run from the page's
// paper to its ink. Pale fills are as near to the dark paper as they were to white. Other hues are lightened until
// their contrast to the dark paper is 4.5. Pictures and paper stay as they are said.
{
  const dark = window.matchMedia("(prefers-color-scheme: dark)"), enough = 4.5, pale = 0.67, white = [255, 255, 255],
        black = 0x22;
  const variable = (name) => channels(getComputedStyle(document.documentElement).getPropertyValue(name).trim());

  function channels(text) {
    const hex = /^#([0-9a-f]{3}|[0-9a-f]{6})$/i.exec(text);
    if (hex)
      return hex[1].length === 3 ? Array.from(hex[1], (c) => parseInt(c + c, 16)) :
                                   [0, 2, 4].map((k) => parseInt(hex[1].slice(k, k + 2), 16));
    const parts = /^rgba?\(([\d.]+), ?([\d.]+), ?([\d.]+)(?:, ?([\d.]+))?\)$/.exec(text);
    return parts ? parts.slice(1, 4).map(Number).concat(parts[4] === undefined ? [] : [Number(parts[4])]) : null;
  }
  // Contrast as WCAG 2.1 defines it, 1 to 21.
  function luminance(rgb) {
    const [r, g, b] =
        rgb.slice(0, 3).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  }
  function contrast(a, b) {
    const [x, y] = [luminance(a), luminance(b)];
    return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
  }
  const mix = (a, b, share) => [0, 1, 2].map((k) => a[k] + share * (b[k] - a[k]));

  function carried(rgb, paper, ink) {
    const least = Math.min(...rgb.slice(0, 3)), most = Math.max(...rgb.slice(0, 3));
    if (most - least < 12) return mix(paper, ink, Math.min(1, (255 - most) / (255 - black)));
    if (least >= pale * 255) return [0, 1, 2].map((k) => rgb[k] - least / 255 * (255 - paper[k]));
    for (let share = 0; share < 1; share += 0.05) {
      const lighter = mix(rgb, white, share);
      if (contrast(lighter.map(Math.round), paper) >= enough) return lighter;
    }
    return white;
  }
  // A colour as it is drawn on this screen; what is no colour stays as it is.
  function colour(text) {
    const rgb = dark.matches && !paper && typeof text === "string" && channels(text);
    if (!rgb) return text;
    const on = carried(rgb, variable("--paper"), variable("--ink")).map(Math.round);
    return rgb.length > 3 ? "rgba(" + on.join(",") + "," + rgb[3] + ")" :
                            "#" + on.map((c) => c.toString(16).padStart(2, "0")).join("");
  }
  // A colour in which words can be read on white paper: darkened until its contrast is enough.
  const readable = new Map();
  function letters(said) {
    if (!readable.has(said)) {
      const rgb = channels(said);
      let out = said;
      for (let share = 0; rgb && share <= 1 && contrast(channels(out), white) < 1.02 * enough; share += 0.05)
        out = "#" + mix(rgb, [0, 0, 0], share).map((c) => Math.round(c).toString(16).padStart(2, "0")).join("");
      readable.set(said, out);
    }
    return readable.get(said);
  }

  // Patches of colour in the page's own text, or in a part of it.
  function paint(part = document) {
    for (const patch of part.querySelectorAll(".swatch[style]")) {
      patch.dataset.colour = patch.dataset.colour || patch.style.backgroundColor;
      patch.style.backgroundColor = colour(patch.dataset.colour);
    }
    for (const mark of part.querySelectorAll(".legend svg [stroke], .legend svg [fill]"))
      for (const name of ["stroke", "fill"]) {
        if (!mark.hasAttribute(name)) continue;
        mark.dataset[name] = mark.dataset[name] || mark.getAttribute(name);
        mark.setAttribute(name, colour(mark.dataset[name]));
      }
  }

  // While the page is printed, its own patches and words have the colours of paper.
  let paper = false;
  const ink = () => (paper ? "#222222" : getComputedStyle(document.documentElement).getPropertyValue("--ink").trim());
  function onPaper(on) {
    paper = on;
    paint();
    if (ricochet.film && on && !ricochet.film.films) ricochet.film.load();
    else if (ricochet.film) ricochet.film.paint();
  }

  const charts = new Set();
  dark.addEventListener("change", () => {
    paint();
    if (ricochet.film) ricochet.film.paint();
    charts.forEach((chart) => chart.draw());
  });

  ricochet.theme = {
    colour,
    letters,
    ink,
    paint,
    onPaper,
    contrast,
    channels,
    // Charts that are drawn again when the screen turns dark or light.
    follow: (chart) => charts.add(chart),
    forget: (chart) => charts.delete(chart)
  };
}
