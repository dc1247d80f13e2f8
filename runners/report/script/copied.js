// A table as text for a sheet, a page or a paper: what it shows, with every digit that the page has.
{
  // Cells in sight, row by row.
  function cellsOf(table) {
    const word = (cell) => {
      if (cell.dataset.value) return cell.dataset.value;
      const copy = cell.cloneNode(true);
      copy.querySelectorAll(".why, .meaning, .copies").forEach((one) => one.remove());
      return copy.textContent.replace(/\s+/g, " ").trim();
    };
    return Array.from(table.rows)
        .filter((row) => !row.hidden)
        .map((row) => Array.from(row.cells).filter((cell) => cell.getClientRects().length).map(word));
  }
  const latex = (text) =>
      text.replace(/[&%$#_{}]/g, "\\$&")
          .replace(
              /[~^\\](?![&%$#_{}])/g,
              (c) => ({"~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "\\": "\\textbackslash{}"})[c]);
  const forms = {
    CSV: (rows) => ricochet.csvText(rows),
    Markdown: (
        [head, ...rows]) => [head, head.map(() => "---"), ...rows]
                                .map((row) => "| " + row.map((cell) => cell.replace(/\|/g, "\\|")).join(" | ") + " |\n")
                                .join(""),
    LaTeX: ([head, ...rows]) => "\\begin{tabular}{" +
        "l".repeat(head.length) + "}\n\\hline\n" +
        [head, ...rows].map((row, k) => row.map(latex).join(" & ") + " \\\\\n" + (k ? "" : "\\hline\n")).join("") +
        "\\hline\n\\end{tabular}\n"
  };
  // To the clipboard; where the browser does not lend it, by a selection.
  ricochet.copy = (text, done) => {
    const selected = () => {
      const place = Object.assign(document.createElement("textarea"), {value: text});
      document.body.append(place);
      place.select();
      if (document.execCommand("copy")) done();
      place.remove();
    };
    if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, selected);
    else selected();
  };
  ricochet.tableText = (table, form) => forms[form](cellsOf(table));
  // Buttons below a table that copy it.
  ricochet.startCopies = (table) => {
    const place = Object.assign(document.createElement("p"), {className: "export copies"});
    for (const form of Object.keys(forms)) {
      const button = Object.assign(
          document.createElement("button"), {type: "button", textContent: form, title: "copy this table as " + form});
      button.addEventListener("click", () => ricochet.copy(ricochet.tableText(table, form), () => {
        button.textContent = "copied";
        setTimeout(() => (button.textContent = form), 1500);
      }));
      place.append(button);
    }
    table.after(place);
  };
}
