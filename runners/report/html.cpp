#include "runners/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>
#include <stdexcept>

#include "runners/report/assets.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report {

std::string filled(std::string_view name, const Fill& with) {
  const std::string_view text = asset("templates/" + std::string(name) + ".html");
  kainjow::mustache::mustache made{std::string(text)};
  if (text.empty() || !made.is_valid())
    throw std::logic_error("template " + std::string(name) + ": " + (text.empty() ? "absent" : made.error_message()));
  made.set_custom_escape([](const std::string& raw) { return escape(raw); });
  return made.render(with);
}

namespace {

/// "1e-07" → "1e-7", "1e+12" → "1e12".
std::string short_exponent(std::string text) {
  const size_t e = text.find('e');
  if (e == std::string::npos) return text;
  size_t from = e + 1;
  if (text[from] == '+') text.erase(from, 1);
  if (text[from] == '-') ++from;
  while (from + 1 < text.size() && text[from] == '0') text.erase(from, 1);
  return text;
}

}  // namespace

std::string escape(std::string_view text) {
  if (!is_plain(text)) return escape(plain_text(text));
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string unbroken(const std::string& text) {
  static const std::regex number("[0-9]+(?:[.][0-9]+)?e-[0-9]+");
  return std::regex_replace(escape(text), number, "<span class=\"whole\">$&</span>");
}

std::string script_json(const nlohmann::ordered_json& value) {
  std::string text = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  replace_all(text, "<", "\\u003c");
  return text;
}

std::string script_text(std::string_view program) {
  std::string text;
  text.reserve(program.size() + 64);
  for (size_t i = 0; i < program.size(); ++i) {
    text += program[i];
    if (program[i] != '<') continue;
    std::string next(program.substr(i + 1, 7));
    std::transform(next.begin(), next.end(), next.begin(), [](unsigned char c) { return std::tolower(c); });
    if (next == "/script" || next.substr(0, 3) == "!--") text += '\\';
  }
  return text;
}

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "not a number";
  if (std::isinf(value)) return value > 0 ? "∞" : "−∞";
  if (value == 0) return "0";
  std::string text = short_exponent(fmt::format("{:.{}g}", value, digits));
  if (text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string exact_text(double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  return short_exponent(std::string(buffer, end.ptr));
}

std::string share_text(double share) {
  return number_text(100 * share, 3) + " %";
}

std::string share_text(double share, std::optional<double> low, std::optional<double> high) {
  return share_text(share) + (low && high ? fmt::format(" ({} to {})", share_text(*low), share_text(*high)) : "");
}

std::string status_mark(Status status) {
  if (status == Status::done) return "✓";
  if (status == Status::refused) return "⊘";
  if (status == Status::diverged) return "✕";
  if (status == Status::failed) return "!";
  return "?";
}

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  const std::size_t bracket = name.find('[');
  return bracket == std::string::npos || !name.ends_with(']')
             ? name
             : name.substr(0, bracket) + " at " + name.substr(bracket + 1, name.size() - bracket - 2);
}

std::string list_text(std::vector<std::string> items, size_t most) {
  const size_t all = items.size();
  items.resize(std::min(all, most));
  return fmt::format("{}{}", fmt::join(items, ", "), all > most ? fmt::format(" and {} more", all - most) : "");
}

std::string count_text(size_t count, std::string_view singular, std::string_view plural) {
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

namespace {

constexpr std::size_t tall_rows = 24;

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

std::string HtmlTable::html(std::size_t most) const {
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
  for (std::size_t k = 0; k < std::min(rows_.size(), most); ++k) out += "<tr>" + rows_[k] + "</tr>\n";
  out += "</tbody></table></div>\n";
  if (rows_.size() > most)
    out += fmt::format("<p class=\"fine\">{} more rows are in the table's CSV file.</p>\n", rows_.size() - most);
  return out + (folded ? "</details>\n" : "");
}

}  // namespace ricochet::report
