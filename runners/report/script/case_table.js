// The table of all cases: sorted by a click on a header, filtered by words and by status.
ricochet.startCaseTable = () => {
  const table = document.getElementById("cases");
  if (!table) return;
  const all = (selector, from) => Array.from(from.querySelectorAll(selector));
  const body = table.tBodies[0], rows = Array.from(body.rows), words = document.getElementById("filter"), shown = document.getElementById("shown");
  const statuses = all("[data-status]", document.querySelector("#all-cases .controls"));
  function filter() {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean), off = new Set(statuses.filter((s) => !s.checked).map((s) => s.dataset.status));
    let count = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = off.has(row.dataset.status) || !wanted.every((w) => text.includes(w));
      count += row.hidden ? 0 : 1;
    }
    shown.textContent = count === rows.length ? "" : count + " of " + rows.length + " rows shown";
  }
  words.addEventListener("input", filter);
  statuses.forEach((s) => s.addEventListener("change", filter));
  // A row opens its case, by a click or by Enter; who marks text wants the text.
  const open = (row) => { if (row && row.dataset.case && ricochet.data && !String(getSelection())) ricochet.showCase(ricochet.data, row.dataset.case); };
  body.addEventListener("click", (event) => open(event.target.closest("tr")));
  body.addEventListener("keydown", (event) => { if (event.key === "Enter" && event.target.matches("tr")) { event.preventDefault(); open(event.target); } });
  document.getElementById("all-columns").addEventListener("change", (e) => table.classList.toggle("full", e.target.checked));
};

// Sorts a table by a click on a header; rows without a value stand last, either way.
ricochet.startSorting = (table) => {
  const body = table.tBodies[0], headers = Array.from(table.querySelectorAll("thead th"));
  const absent = (v) => v === "–" || v === "";
  function sort(header) {
    const index = headers.indexOf(header), up = header.getAttribute("aria-sort") !== "ascending";
    headers.forEach((h) => h.setAttribute("aria-sort", "none"));
    header.setAttribute("aria-sort", up ? "ascending" : "descending");
    const key = (row) => { const cell = row.cells[index], v = cell.dataset.value; return v !== undefined ? Number(v) : cell.textContent.trim(); };
    const compare = (a, b) => {
      const x = key(a), y = key(b);
      if (absent(x) || absent(y)) return absent(x) - absent(y);
      if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
      const order = typeof x === "number" ? x - y : x.localeCompare(y);
      return up ? order : -order;
    };
    Array.from(body.rows).sort(compare).forEach((row) => body.appendChild(row));
  }
  headers.forEach((h) => { const button = h.querySelector("button"); if (button) button.addEventListener("click", () => sort(h)); });
};
