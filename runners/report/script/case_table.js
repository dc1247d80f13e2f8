// The table of all cases, filtered by words, by conditions on columns and by status. A click on a header sorts it. A
// button saves what it shows as CSV.
ricochet.startCaseTable = () => {
  const table = document.getElementById("cases");
  const all = (selector, from) => Array.from(from.querySelectorAll(selector));
  const body = table.tBodies[0], rows = Array.from(body.rows), words = document.getElementById("filter"),
        shown = document.getElementById("shown");
  const heads = all("thead th", table), columns = heads.map((head) => head.dataset.column),
        statuses = all("[data-status]", document.querySelector("#all-cases .controls"));
  function filter() {
    const asked = ricochet.readFilter(words.value, columns),
          off = new Set(statuses.filter((s) => !s.checked).map((s) => s.dataset.status));
    const places = asked.conditions.map(({column, holds}) => [columns.indexOf(column), holds]);
    let count = 0;
    for (const row of rows) {
      const text = asked.words.length ? row.textContent.toLowerCase().replace(/_/g, " ") : "";
      row.hidden = off.has(row.dataset.status) || !asked.words.every((w) => text.includes(w)) ||
          !places.every(([place, holds]) => holds(ricochet.cellValue(row.cells[place])));
      count += row.hidden ? 0 : 1;
    }
    words.setAttribute("aria-invalid", String(asked.wrong !== ""));
    if (document.activeElement === words) ricochet.address.ofCases(words.value);
    shown.textContent = asked.wrong || (count === rows.length ? "" : count + " of " + rows.length + " rows shown");
  }
  words.addEventListener("input", filter);
  statuses.forEach((s) => s.addEventListener("change", filter));
  const full = document.getElementById("all-columns");
  if (full) full.addEventListener("change", (e) => table.classList.toggle("full", e.target.checked));
  // A row opens its case, by a click or by Enter; who marks text wants the text.
  const open = (row) => {
    if (row && row.dataset.case && ricochet.data && !String(getSelection()))
      ricochet.showCase(ricochet.data, row.dataset.case);
  };
  body.addEventListener("click", (event) => open(event.target.closest("tr")));
  body.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.matches("tr")) {
      event.preventDefault();
      open(event.target);
    }
  });

  // Columns and rows in sight, in their order; numbers with all digits where the page has them.
  ricochet.casesShown = () => {
    const places = heads.map((head, k) => k).filter((k) => heads[k].getClientRects().length > 0),
          {byId} = ricochet.data || {byId: new Map()};
    const value = (row, k) => {
      const one = byId.get(row.cells[0].textContent), exact = one && one.measures[columns[k]],
            axis = one && one.values[columns[k]], found = ricochet.cellValue(row.cells[k]);
      return exact !== undefined    ? exact :
          axis                      ? axis.text :
          found === null            ? "" :
          typeof found === "number" ? found :
                                      ricochet.cellText(row.cells[k]);
    };
    return ricochet.csvText([places.map((k) => columns[k])].concat(
        Array.from(body.rows).filter((row) => !row.hidden).map((row) => places.map((k) => value(row, k)))));
  };
  document.getElementById("cases-csv")
      .addEventListener(
          "click",
          () => ricochet.download(
              document.title.split(" · ")[0] + "-cases", "csv", new Blob([ricochet.casesShown()], {type: "text/csv"})));
};
