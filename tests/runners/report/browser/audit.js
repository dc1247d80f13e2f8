// What a reader cannot read: boxes that pass the right edge or, on paper, their lower one, letters below 12 pixels,
// contrast below 4.5 (WCAG 2.1), words that lie on each other or pass the edge of their chart, marks that the edge of
// a plot cuts, axes with less than two numbers. Paper has its own drawings, and the summary's letters go down to 6.5
// points, those of captions and legends to 0.86 of that. An expression that gives a list of what is wrong.
(() => {
  const paper = matchMedia("print").matches;
  ricochet.later.fillAll();
  paper ? ricochet.paper.prepare() : ricochet.figures.forEach((figure) => figure.drawAll());
  const out = [], {contrast, channels} = ricochet.theme, least = 4.5, smallest = paper ? 7.4 : 11.95,
        scrolls = (paper ? ".on-paper svg *, .drawing svg *" : ".scroll") +
      ", .extremes, .hidden, .skip, .notes, pre, script, noscript";
  const seen = (e) => e.getClientRects().length > 0,
        said = (e) => e.tagName + " " + (e.className.baseVal ?? e.className) + " " + e.textContent.trim().slice(0, 40);
  const behind = (e) => {
    for (; e; e = e.parentElement) {
      const c = channels(getComputedStyle(e).backgroundColor);
      if (c && (c[3] === undefined || c[3] > 0.5)) return c;
    }
    return [255, 255, 255];
  };
  const has = (e) => Array.from(e.childNodes).some((n) => n.nodeType === 3 && n.textContent.trim());
  for (const e of document.querySelectorAll("body *")) {
    if (!seen(e)) continue;
    if (!e.closest(scrolls) && e.getBoundingClientRect().right > innerWidth + 1)
      out.push("passes the edge: " + said(e));
    if (paper && e.matches(".scroll, .notes, .told, figure, section, details") && e.scrollHeight > e.clientHeight + 2)
      out.push("goes on beneath its box: " + said(e));
    if (!has(e) || e.closest("script, noscript, .skip, .hidden, [aria-pressed=false], sup, sub")) continue;
    const style = getComputedStyle(e), svg = e.closest("svg"), box = svg && svg.viewBox.baseVal,
          size = parseFloat(style.fontSize) * (box && box.width ? svg.getBoundingClientRect().width / box.width : 1),
          found = contrast(channels(svg ? style.fill : style.color), behind(e));
    if (size < smallest) out.push("letters of " + size.toFixed(1) + ": " + said(e));
    if (found < least) out.push("contrast " + found.toFixed(2) + ": " + said(e));
  }
  // Letters take the middle nine of their box's fourteen pixels.
  const apart = (boxes, where) => boxes.forEach(([a, left, top, right, bottom], k) => {
    for (const [b, low, high, far, deep] of boxes.slice(k + 1))
      if (left + 1 < far - 1 && low + 1 < right - 1 && top + 3 < deep - 3 && high + 3 < bottom - 3)
        out.push("words on each other, " + where + ": " + a + " | " + b);
  });
  for (const svg of document.querySelectorAll("svg"))
    apart(
        Array.from(svg.querySelectorAll("text"))
            .filter((one) => seen(one) && one.textContent.trim().length > 1)
            .map((one) => {
              const {left, top, right, bottom} = one.getBoundingClientRect();
              return [one.textContent, left, top, right, bottom];
            }),
        svg.getAttribute("class"));
  for (const {description, slots} of ricochet.figures)
    for (const {chart} of slots) {
      if (!chart || !chart.view || !seen(chart.element)) continue;
      const {width, height, xs, ys, marks, pen: {words}} = chart.plot, half = 6, slack = 7;
      for (const scale of [...xs, ...ys])
        if (!scale.axis.hidden && !scale.axis.bare && scale.axis.type !== "category" &&
            scale.ticks().filter((tick) => tick.words).length < 2)
          out.push("an axis with less than two numbers, " + description.id + ": " + scale.axis.name);
      for (const mark of marks.filter((one) => one.mark === "words")) {
        const {x, y, frame} = chart.plot.placed(mark), {reader, countOf} = ricochet.plot;
        for (let i = 0; i < countOf(mark); ++i) {
          const px = x.at(reader(mark, "x")(i)), py = y.at(reader(mark, "y")(i));
          if (px - half < frame.x - slack || px + half > frame.x + frame.width + slack || py - half < frame.y - slack ||
              py + half > frame.y + frame.height + slack)
            out.push("a mark that the plot's edge cuts, " + description.id + ": " + mark.name);
        }
      }
      apart(words.filter(([text]) => text.trim().length > 1), description.id);
      for (const [text, left, top, right, bottom] of words)
        if (left < -1 || top < -1 || right > width + 1 || bottom > height + 1)
          out.push("passes its chart, " + description.id + ": " + text);
    }
  return Array.from(new Set(out));
})()
