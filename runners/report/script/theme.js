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
      if (contrast(lighter, paper) >= enough) return lighter;
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
  // The same for all that an option holds, but for its rows.
  function carry(part, key) {
    if (typeof part === "string") return colour(part);
    if (typeof part === "function" && /color$/i.test(key)) return (...given) => colour(part(...given));
    if (Array.isArray(part)) return part.length > 2000 ? part : part.map((one) => carry(one, key));
    if (!part || typeof part !== "object" || Object.getPrototypeOf(part) !== Object.prototype) return part;
    return Object.fromEntries(
        Object.entries(part).map(([name, value]) => [name, name === "dataset" ? value : carry(value, name)]));
  }
  function onScreen(option) {
    if (!dark.matches) return option;
    const tooltip = option.tooltip && {backgroundColor: "#ffffff", borderColor: "#bbbbbb", ...option.tooltip};
    return carry({...option, ...(tooltip ? {tooltip} : {})}, "");
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

  const redraws = new Map();
  dark.addEventListener("change", () => {
    paint();
    if (ricochet.film) ricochet.film.paint();
    for (const [chart, redraw] of redraws) chart.isDisposed() ? redraws.delete(chart) : redraw();
  });
  // A chart of this screen. `redraw` draws it again when the screen turns dark or light; without it, the last option
  // is.
  function openChart(element, redraw) {
    const chart = echarts.init(element, null, {renderer: "canvas"}), set = chart.setOption.bind(chart);
    let last = {};
    chart.setOption = (option, ...rest) => {
      last = option;
      return set(onScreen(option), ...rest);
    };
    redraws.set(chart, redraw || (() => set(onScreen(last), true)));
    return chart;
  }

  Object.assign(ricochet, {openChart, theme: {colour, ink, paint, onPaper, contrast, channels}});
}
