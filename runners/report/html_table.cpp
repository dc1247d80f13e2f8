#include "runners/report/html_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

constexpr std::size_t most_rows = 100, tall_rows = 24;

/// ` name="value"`, escaped; nothing for an empty value.
std::string attribute(const char* name, std::string_view value) {
  return value.empty() ? "" : fmt::format(" {}=\"{}\"", name, escape(value));
}

}  // namespace

std::string swatch(std::string_view colour) {
  return fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", colour);
}

HtmlTable& HtmlTable::row() {
  rows_.emplace_back();
  return *this;
}

HtmlTable& HtmlTable::row(std::string_view head, std::string_view colour, std::string_view html) {
  rows_.push_back(
      fmt::format("<th scope=\"row\">{}{}{}</th>", colour.empty() ? "" : swatch(colour), escape(head), html));
  return *this;
}

HtmlTable& HtmlTable::cell(std::string_view html, std::string_view attributes) {
  rows_.back() += fmt::format("<td{}>{}</td>", attributes, html);
  return *this;
}

HtmlTable& HtmlTable::text(std::string_view text, std::string_view classes, std::string_view tooltip) {
  return cell(text.empty() ? "–" : escape(text), attribute("class", classes) + attribute("title", tooltip));
}

HtmlTable& HtmlTable::number(std::optional<double> value, int digits) {
  return value ? number(number_text(*value, digits), exact_text(*value)) : absent();
}

HtmlTable& HtmlTable::number(std::string_view text, std::string_view tooltip, std::string_view classes) {
  const std::string all = classes.empty() ? "number" : "number " + std::string(classes);
  return cell(escape(text), attribute("class", all) + attribute("title", tooltip));
}

HtmlTable& HtmlTable::absent(bool number, std::string_view text) {
  return cell(escape(text), attribute("class", number ? "number absent" : "absent"));
}

std::string HtmlTable::html() const {
  if (rows_.empty()) return "";
  // One without a caption stands in something that folds.
  const bool folded = rows_.size() > tall_rows && !caption_.empty();
  std::string out;
  if (folded)
    out = fmt::format("<details class=\"table\"><summary>{} <span class=\"fine\">({} rows)</span></summary>\n",
                      caption_.substr(0, std::min(caption_.find(". "), caption_.find_last_not_of('.') + 1)),
                      rows_.size());
  out += fmt::format("<div class=\"scroll{}\"><table class=\"{}\"><caption>{}</caption>\n<thead><tr>",
                     rows_.size() > tall_rows ? " tall" : "", classes_, caption_);
  for (const Head& head : heads_)
    out += fmt::format("<th scope=\"col\"{}{}>{}{}</th>", attribute("class", head.number ? "number" : ""),
                       attribute("title", head.tooltip), head.colour.empty() ? "" : swatch(head.colour),
                       escape(head.text));
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t k = 0; k < std::min(rows_.size(), most_rows); ++k) out += "<tr>" + rows_[k] + "</tr>\n";
  out += "</tbody></table></div>\n";
  if (rows_.size() > most_rows)
    out += fmt::format("<p class=\"fine\">{} more rows are in the table's CSV file.</p>\n", rows_.size() - most_rows);
  return out + (folded ? "</details>\n" : "");
}

}  // namespace ricochet::report
