#include "tests/runners/command/page_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace ricochet::tests {
namespace {

/// "NAME, KEY VALUE, …" of the first cell as conditions on an axis.
std::vector<std::string> conditions_of(const std::string& label, const std::string& axis) {
  std::vector<std::string> conditions;
  for (const std::string& piece : pieces_of(label, ',')) {
    const std::vector<std::string> words = words_of(piece);
    if (words.size() == 1)
      conditions.push_back(axis + "=" + words[0]);
    else if (words.size() == 2)
      conditions.push_back(axis + "." + words[0] + "=" + words[1]);
    else
      throw std::runtime_error("expected NAME, KEY VALUE, …: " + label);
  }
  return conditions;
}

constexpr std::string_view figure_mark = "<!--=", column_mark = "<!--|", mark_end = "-->";

/// What is written before a comment: up to what no number has.
std::size_t figure_begin(const std::string& line, std::size_t end) {
  static const std::string minus = "−";
  std::size_t at = end;
  while (at > 0) {
    if (std::string_view("0123456789.e+-").find(line[at - 1]) != std::string_view::npos)
      --at;
    else if (at >= minus.size() && line.compare(at - minus.size(), minus.size(), minus) == 0)
      at -= minus.size();
    else
      break;
  }
  return at;
}

/// The cells of a row of a table of the page, with their places.
std::vector<std::pair<std::size_t, std::size_t>> cells_of(const std::string& line) {
  std::vector<std::pair<std::size_t, std::size_t>> cells;
  bool comment = false;
  std::size_t begin = 1;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line.compare(i, 4, "<!--") == 0) comment = true;
    if (line.compare(i, 3, "-->") == 0) comment = false;
    if (line[i] == '|' && !comment && line[i - 1] != '\\') {
      cells.emplace_back(begin, i);
      begin = i + 1;
    }
  }
  return cells;
}

std::string comment_in(const std::string& text, std::string_view mark) {
  const std::size_t begin = text.find(mark), end = text.find(mark_end, begin);
  return begin == std::string::npos || end == std::string::npos
             ? ""
             : text.substr(begin + mark.size(), end - begin - mark.size());
}

class Page {
 public:
  Page(const TablesOf& tables, const std::set<std::string>& studies) : tables_(tables), studies_(studies) {}

  PageFigures read(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string line = text.substr(begin, end - begin);
      ++line_;
      if (!line.starts_with("|")) columns_.clear();
      if (line.find(column_mark) != std::string::npos)
        read_head(line);
      else if (!columns_.empty() && !line.starts_with("|--"))
        line = columns_line(line);
      out_.text += figures_line(line) + (end < text.size() ? "\n" : "");
      begin = end + 1;
    }
    return std::move(out_);
  }

 private:
  bool wanted(const std::string& study) const { return studies_.empty() || studies_.contains(study); }

  void tell(const std::string& where, const std::string& said) {
    out_.wrong.push_back(fmt::format("line {}: {}: {}", line_, trimmed(where), said));
  }

  std::string figures_line(std::string line) {
    for (std::size_t at = line.find(figure_mark); at != std::string::npos; at = line.find(figure_mark, at)) {
      const std::size_t end = line.find(mark_end, at);
      const std::string mark = line.substr(at + figure_mark.size(), end - at - figure_mark.size());
      const std::size_t begin = figure_begin(line, at);
      const std::string old = line.substr(begin, at - begin);
      std::string now = old;
      try {
        const std::vector<std::string> parts = pieces_of(mark, ';');
        if (parts.size() != 3) throw std::runtime_error("expected rows; expression; format");
        const Source source = source_of(parts[0]);
        if (wanted(source.study)) {
          ++out_.figures;
          now = written(value_of(tables_, source, parts[1]), trimmed(parts[2]));
          if (old.starts_with("−") && now.starts_with("-")) now = "−" + now.substr(1);
          if (now != old) tell(mark, fmt::format("written {}, computed {}", old.empty() ? "nothing" : old, now));
        }
      } catch (const std::exception& error) {
        tell(mark, error.what());
      }
      line.replace(begin, old.size(), now);
      at = begin + now.size() + 1;
    }
    return line;
  }

  void read_head(const std::string& line) {
    columns_.clear();
    for (const auto& [begin, end] : cells_of(line))
      columns_.push_back(comment_in(line.substr(begin, end - begin), column_mark));
  }

  // Study, table and axis stand in the first column's comment.
  std::string columns_line(const std::string& line) {
    const auto cells = cells_of(line);
    const std::vector<std::string> table = words_of(columns_.front());
    std::string out = line.substr(0, 1);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string cell = line.substr(cells[c].first, cells[c].second - cells[c].first), old = trimmed(cell);
      std::string now = old;
      if (c > 0 && c < columns_.size() && !columns_[c].empty()) {
        const std::string label = trimmed(line.substr(cells[0].first, cells[0].second - cells[0].first));
        const std::string where = fmt::format("{} {} {}; {}", table.at(0), table.at(1), label, trimmed(columns_[c]));
        try {
          if (wanted(table.at(0))) {
            ++out_.figures;
            now = column_cell(table, label, columns_[c]);
            if (now != old)
              tell(where, fmt::format("written {}, computed {}", old.empty() ? "nothing" : old,
                                      now.empty() ? "nothing" : now));
          }
        } catch (const std::exception& error) {
          tell(where, error.what());
        }
      }
      out += now == old ? cell : " " + now + " ";
      out += "|";
    }
    return out;
  }

  std::string column_cell(const std::vector<std::string>& table, const std::string& label,
                          const std::string& column) const {
    const std::vector<std::string> parts = pieces_of(column, ';');
    Source source{table.at(0), table.at(1), conditions_of(label, table.at(2))};
    for (const std::string& condition : words_of(parts[0])) source.conditions.push_back(condition);
    if (text_of(tables_, source, "status") == "done") return filled(tables_, source, trimmed(parts.at(1)));
    return parts.size() > 2 ? filled(tables_, source, trimmed(parts[2])) : "";
  }

  const TablesOf& tables_;
  const std::set<std::string>& studies_;
  int line_ = 0;
  std::vector<std::string> columns_;  // comments of the table under way
  PageFigures out_;
};

}  // namespace

PageFigures compare_page(const std::string& page, const TablesOf& tables, const std::set<std::string>& studies) {
  return Page(tables, studies).read(page);
}

std::set<std::string> studies_of(const std::string& page) {
  std::set<std::string> out;
  for (const std::string_view mark : {figure_mark, column_mark})
    for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
      const std::vector<std::string> words =
          words_of(page.substr(at + mark.size(), page.find(mark_end, at) - at - mark.size()));
      if (!words.empty() && words.front().find_first_of("=<>") == std::string::npos) out.insert(words.front());
    }
  return out;
}

std::vector<std::filesystem::path> pages_of_findings(const std::filesystem::path& source) {
  const std::filesystem::directory_iterator folder(source / "studies/findings");
  std::vector<std::filesystem::path> pages(begin(folder), end(folder));
  std::sort(pages.begin(), pages.end());
  return pages;
}

}  // namespace ricochet::tests
