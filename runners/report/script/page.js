// The page: reads its data, makes its figures, and draws their charts as they come into sight.
{
  const read = (id) => {
    const e = document.getElementById(id);
    return e ? JSON.parse(e.textContent) : null;
  };
  const figures = ricochet.figures = [];

  // Says of a box whether it holds more than it shows, and whether there is more to the right or below. Such a box can
  // be reached and scrolled by keys. All boxes are measured before any is changed: a page is laid out once for all.
  const resized = new Set(), widths = new ResizeObserver((entries) => entries.forEach(({target}) => lookAt(target)));
  function lookAt(box) {
    if (!resized.size)
      requestAnimationFrame(() => {
        const found = Array.from(resized, (one) => [one, [
                                            ["wide", one.scrollWidth - one.clientWidth, one.scrollLeft],
                                            ["tall", one.scrollHeight - one.clientHeight, one.scrollTop]
                                          ]]);
        resized.clear();
        for (const [one, ways] of found) {
          for (const [way, more, at] of ways) {
            if (more > 1) one.dataset[way] = at < more - 1 ? "more" : "all";
            else delete one.dataset[way];
          }
          if (ways.some(([, more]) => more > 1)) one.tabIndex = 0;
          else one.removeAttribute("tabindex");
        }
      });
    resized.add(box);
  }
  function watchWidth(box) {
    box.addEventListener("scroll", () => lookAt(box), {passive: true});
    widths.observe(box);
  }
  ricochet.watchWidth = watchWidth;

  const owner = new Map();
  const later = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      later.unobserve(entry.target);
      const [figure, slot] = owner.get(entry.target) || [];
      if (slot && !slot.chart) figure.draw(slot);
    }
  }, {rootMargin: "400px"});

  // Brings a figure to the page: `put` places its section, and its charts are drawn as they come into sight.
  ricochet.mount = (description, put) => {
    const section = ricochet.figureSection(description);
    ricochet.theme.paint(section);
    put(section);
    const figure = new (description.map ? ricochet.CaseMap : ricochet.Figure)(description, section);
    figures.push(figure);
    for (const slot of figure.slots) {
      owner.set(slot.element, [figure, slot]);
      later.observe(slot.element);
    }
    // A figure that takes several forms is made anew in its place.
    const choices = Array.from(section.querySelectorAll("[data-choice]"));
    choices.forEach((choice, k) => choice.addEventListener("change", () => {
      const next = ricochet.mount(
          description.remake(choices.map((one) => one.selectedIndex)), (fresh) => section.replaceWith(fresh));
      ricochet.unmount(figure);
      next.show(Math.min(figure.view, next.description.views.length - 1));
      const again = next.section.querySelectorAll("[data-choice]")[k];
      if (again) again.focus();
    }));
    return figure;
  };
  ricochet.unmount = (figure) => {
    for (const {element, chart} of figure.slots) {
      owner.delete(element);
      later.unobserve(element);
      if (chart) chart.dispose();
    }
    figures.splice(figures.indexOf(figure), 1);
    figure.section.remove();
  };

  function startFigures() {
    const page = read("page-data"), place = document.getElementById("figures");
    if (!page || !place) return;
    const data = new ricochet.PageData(page, read("curve-data"));
    data.view = new ricochet.Cases(data);
    ricochet.data = data;
    const all = ricochet.bounded(ricochet.makeFigures(data)), answer = all.find(({answers}) => answers),
          beside = document.getElementById("answer-figure");
    let after = place, link = document.getElementById("figure-links");
    for (const description of all) {
      const answers = beside && description === answer,
            put = (fresh) => (answers ? beside.append(fresh) : after.after(fresh));
      const figure = ricochet.mount(description, put), {section} = figure,
            entry =
                Object.assign(document.createElement("a"), {href: "#" + section.id, textContent: description.title});
      if (answers) {
        beside.parentElement.classList.add("beside");
        if (description.atFirst) figure.show(description.atFirst);
      } else after = section;
      link.after(entry);
      link = entry;
    }
    ricochet.startFilm(data, after, link);
    if (!figures.length) place.remove();
    let pending = 0;
    window.addEventListener("resize", () => {
      clearTimeout(pending);
      pending = setTimeout(() => figures.forEach((f) => f.slots.forEach((s) => s.chart && s.chart.draw())), 120);
    });
  }

  window.addEventListener("beforeprint", () => {
    ricochet.theme.onPaper(true);
    ricochet.paper.prepare();
  });
  window.addEventListener("afterprint", () => {
    ricochet.paper.finish();
    ricochet.theme.onPaper(false);
  });

  // The summary takes its figure when it is asked for; printed from there, it is all that is printed.
  function startSummary() {
    const place = document.getElementById("summary-figure"), button = document.getElementById("print-summary");
    if (!place) return;
    const follow = () => {
      if (location.hash === "#summary") ricochet.paper.showFirst(place);
    };
    window.addEventListener("hashchange", follow);
    button.addEventListener("click", () => window.print());
    follow();
  }

  document.addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll("table.sortable, table.cases").forEach(ricochet.startSorting);
    document.querySelectorAll(".scroll > table").forEach(ricochet.startCopies);
    if (document.getElementById("cases")) ricochet.startCaseTable();
    document.querySelectorAll(".scroll").forEach(watchWidth);
    ricochet.later.startTables((box) => {
      box.querySelectorAll("table").forEach(ricochet.startSorting);
      box.querySelectorAll("table").forEach(ricochet.startCopies);
      if (box.querySelector("#cases")) ricochet.startCaseTable();
      watchWidth(box);
      ricochet.theme.paint(box);
    });
    // Every digit of a number that is shown short.
    document.addEventListener("mouseover", ({target}) => {
      if (target.dataset && target.dataset.value && !target.title) target.title = target.dataset.value;
    });
    startFigures();
    for (const id of ["answer", "beneath", "methods"]) {
      const section = document.getElementById(id);
      // Answers of asks say what they mean.
      if (section && !section.querySelector(".asked")) ricochet.explainWords(section);
    }
    if (ricochet.startExport()) return;
    startSummary();
    ricochet.address.open();
    ricochet.theme.paint();
  });
}
