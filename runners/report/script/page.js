// The page: reads its data, makes its figures, and draws their charts as they come into sight.
{
  const read = (id) => { const e = document.getElementById(id); return e ? JSON.parse(e.textContent) : null; };
  const figures = ricochet.figures = [];

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
    ricochet.startFilm(data, after, link);
    if (!figures.length) place.remove();
    // A link from elsewhere names a figure that was not there when the page was read.
    const target = location.hash.startsWith("#figure-") && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (target) target.scrollIntoView();
    let pending = 0;
    window.addEventListener("resize", () => {
      clearTimeout(pending);
      pending = setTimeout(() => figures.forEach((f) => f.slots.forEach((s) => s.chart && s.chart.resize())), 120);
    });
    window.addEventListener("beforeprint", () => figures.forEach((f) => f.drawAll()));
  }

  document.addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll("table.sortable, table.cases").forEach(ricochet.startSorting);
    ricochet.startCaseTable();
    startFigures();
  });
}
