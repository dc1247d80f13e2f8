#include "runners/table/dictionary.hpp"

namespace ricochet {

Table dictionary_of(const std::vector<Table>& tables) {
  Table dictionary{"dictionary",
                   "One column of one table of this folder, or what a row of the table stands for.",
                   {{"table", "",
                     "Name of the table, that of its file without .csv; curves are the files in curves/, or in an "
                     "export curves.csv."},
                    {"column", "", "Name of the column; empty where the line is about the rows of the table."},
                    {"unit", "", "Its unit: SI, 1 for ratios and counts, empty for words and truth values."},
                    {"meaning", "", "What the cells mean."}},
                   {}};
  const auto list = [&](const Table& table) {
    dictionary.rows.push_back({table.name, "", "", table.text});
    for (const Column& column : table.columns)
      dictionary.rows.push_back({table.name, column.name, column.unit, column.text});
  };
  for (const Table& table : tables) list(table);
  // A copy: the rows grow while it is listed.
  list(Table{dictionary.name, dictionary.text, dictionary.columns, {}});
  return dictionary;
}

}  // namespace ricochet
