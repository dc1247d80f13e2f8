// The page: reads its data, makes its figures, and draws their charts as they come into sight.
{
  const read = (id) => { const e = document.getElementById(id); return e ? JSON.parse(e.textContent) : null; };
  const figures = ricochet.figures = [];

  // A finger on a chart is the page's: the chart library hears of taps alone, as clicks.
  const ofPage = (event) => { if (event.target.closest && event.target.closest("[_echarts_instance_]")) event.stopPropagation(); };
  for (const name of ["touchstart", "touchmove", "touchend", "touchcancel"]) document.addEventListener(name, ofPage, { capture: true, passive: true });

  // Says of a box whether its table is wider than it, and whether there is more to the right; such a box can be reached and scrolled by keys.
  function watchWidth(box) {
    const look = () => {
      const more = box.scrollWidth - box.clientWidth;
      if (more > 1) { box.dataset.wide = box.scrollLeft < more - 1 ? "more" : "all"; box.tabIndex = 0; }
      else { delete box.dataset.wide; box.removeAttribute("tabindex"); }
    };
    box.addEventListener("scroll", look, { passive: true });
    new ResizeObserver(look).observe(box);
    look();
  }
  ricochet.watchWidth = watchWidth;

  function startFigures() {
    const page = read("page-data"), place = document.getElementById("figures");
    if (!page || !place || typeof echarts === "undefined") return;
    const data = new ricochet.PageData(page, read("curve-data"));
    data.view = new ricochet.Cases(data);
    ricochet.data = data;
    const owner = new Map();
    const later = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        later.unobserve(entry.target);
        const [figure, slot] = owner.get(entry.target);
        if (!slot.chart) figure.draw(slot);
      }
    }, { rootMargin: "400px" });
    let after = place, link = document.querySelector('nav a[href="#answer"]');
    for (const description of ricochet.makeFigures(data)) {
      const section = ricochet.figureSection(description), entry = Object.assign(document.createElement("a"), { href: "#" + section.id, textContent: description.title });
      after.after(section);
      after = section;
      link.after(entry);
      link = entry;
      const figure = new ricochet.Figure(description, section);
      figures.push(figure);
      for (const slot of figure.slots) { owner.set(slot.element, [figure, slot]); later.observe(slot.element); }
    }
    if (!figures.length) place.remove();
    // A link from elsewhere names a figure that was not there when the page was read.
    const target = location.hash.startsWith("#figure-") && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (target) target.scrollIntoView();
    let pending = 0;
    window.addEventListener("resize", () => {
      clearTimeout(pending);
      pending = setTimeout(() => figures.forEach((f) => f.slots.forEach((s) => s.chart && s.chart.resize())), 120);
    });
  }

  window.addEventListener("beforeprint", () => ricochet.paper.prepare());
  window.addEventListener("afterprint", () => ricochet.paper.finish());

  // The summary takes its figure when it is asked for; printed from there, it is all that is printed.
  function startSummary() {
    const place = document.getElementById("summary-figure"), button = document.getElementById("print-summary");
    if (!place) return;
    const look = () => { if (location.hash === "#summary") ricochet.paper.showFirst(place); };
    window.addEventListener("hashchange", look);
    button.addEventListener("click", () => window.print());
    look();
  }

  document.addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll("table.sortable, table.cases").forEach(ricochet.startSorting);
    ricochet.startCaseTable();
    document.querySelectorAll(".scroll").forEach(watchWidth);
    startFigures();
    startSummary();
    ricochet.theme.paint();
  });
}
