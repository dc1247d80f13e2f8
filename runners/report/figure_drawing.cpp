#include "runners/report/figure_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report::ask_figures {

double width_of(const std::string& text) {
  return glyph * static_cast<double>(shown_width(text));
}

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number() || !std::isfinite(found->get<double>())) return std::nullopt;
  return found->get<double>();
}

std::vector<double> numbers_of(const Json& object, const char* key) {
  std::vector<double> out;
  if (const auto found = object.find(key); found != object.end() && found->is_array())
    for (const Json& one : *found)
      if (one.is_number() && std::isfinite(one.get<double>())) out.push_back(one.get<double>());
  return out;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

Mark::Mark(const Json& row) : value(number_of(row, "value")), low(number_of(row, "low")), high(number_of(row, "high")) {
  if (!low || !high) low = high = std::nullopt;
}

void Mark::add_to(std::vector<double>& all) const {
  for (const auto& one : {value, low, high})
    if (one) all.push_back(*one);
}

std::string words_of(const std::string& name, const Mark& mark, const std::string& unit) {
  std::string out = name.empty() ? "" : name + ": ";
  out += mark.value ? number_text(*mark.value, 5) : "no value";
  if (mark.low) out += fmt::format(" ({} to {})", number_text(*mark.low, 5), number_text(*mark.high, 5));
  return out + (unit.empty() || !mark.value ? "" : " " + unit);
}

std::vector<std::string> wrapped(const std::string& text, double most) {
  std::vector<std::string> lines{""};
  std::size_t at = 0;
  const std::string plain = plain_text(text);
  while (at < plain.size()) {
    const std::size_t end = std::min(plain.find(' ', at), plain.size());
    std::string word = plain.substr(at, end - at);
    at = end + 1;
    if (!lines.back().empty() && width_of(lines.back() + " " + word) > most) lines.emplace_back();
    // A word that no line holds is cut.
    while (width_of(word) > most) {
      std::size_t cut = 0;
      for (std::size_t shown = 0; cut < word.size(); ++cut) {
        if ((static_cast<unsigned char>(word[cut]) & 0xC0) != 0x80 && glyph * static_cast<double>(++shown) > most)
          break;
      }
      if (cut == 0) break;
      if (!lines.back().empty()) lines.emplace_back();
      lines.back() = word.substr(0, cut);
      word.erase(0, cut);
      if (!word.empty()) lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

namespace {

std::string titled(const std::string& title) {
  return title.empty() ? "" : "<title>" + escape(title) + "</title>";
}

}  // namespace

void Drawing::line(double x1, double y1, double x2, double y2, const std::string& classes) {
  out_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" class=\"{}\"/>\n", x1, y1, x2, y2,
                      classes);
}

void Drawing::box(double x, double y, double w, double h, const std::string& classes, const std::string& title,
                  const std::string& colour) {
  out_ +=
      fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" class=\"{}\"{}>{}</rect>\n", x, y,
                  w, h, classes, colour.empty() ? "" : fmt::format(" style=\"--c:{}\"", escape(colour)), titled(title));
}

void Drawing::text(double x, double y, const std::string& words, const std::string& classes, const char* anchor) {
  out_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\"{}{}>{}</text>\n", x, y,
                      anchor == std::string_view("start") ? "" : fmt::format(" text-anchor=\"{}\"", anchor),
                      classes.empty() ? "" : fmt::format(" class=\"{}\"", classes), escape(words));
}

void Drawing::sign(double x, double y, std::size_t series, const std::string& title) {
  // Eight colours, four signs, and all of them hollow.
  const bool hollow = series / (4 * colours) % 2 == 1;
  const std::string classes = fmt::format("dot s{}{}", series % colours, hollow ? " hollow" : "");
  const double d = dot;
  switch ((series + series / colours) % 4) {
    case 0:
      out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" class=\"{}\">{}</circle>\n", x, y, d, classes,
                          titled(title));
      break;
    case 1:
      box(x - 0.9 * d, y - 0.9 * d, 1.8 * d, 1.8 * d, classes, title);
      break;
    case 2:
      path(fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}h{:.2f}z", x, y - 1.1 * d, 1.1 * d, 2 * d, -2.2 * d), classes,
           title);
      break;
    default:
      path(fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}l{:.2f} {:.2f}l{:.2f} {:.2f}z", x, y - 1.2 * d, 1.2 * d, 1.2 * d,
                       -1.2 * d, 1.2 * d, -1.2 * d, -1.2 * d),
           classes, title);
  }
}

void Drawing::path(const std::string& d, const std::string& classes, const std::string& title) {
  out_ += fmt::format("<path d=\"{}\" class=\"{}\">{}</path>\n", d, classes, titled(title));
}

void Drawing::whisker(double low, double high, double across, bool upright, std::size_t series) {
  const std::string classes = fmt::format("whisker s{}", series % colours);
  constexpr double e = 3;  // its ends to each side
  std::string d;
  if (upright)
    d = fmt::format("M{0:.2f} {1:.2f}V{2:.2f}M{3:.2f} {1:.2f}h{4:g}M{3:.2f} {2:.2f}h{4:g}", across, low, high,
                    across - e, 2 * e);
  else
    d = fmt::format("M{0:.2f} {1:.2f}H{2:.2f}M{0:.2f} {3:.2f}v{4:g}M{2:.2f} {3:.2f}v{4:g}", low, across, high,
                    across - e, 2 * e);
  path(d, classes);
}

std::string Drawing::svg(double height, const std::string& label, bool plane) const {
  return fmt::format(
      "<svg class=\"ask-figure{}\" viewBox=\"0 0 {:g} {:.0f}\" role=\"img\" aria-label=\"{}\" "
      "xmlns=\"http://www.w3.org/2000/svg\">\n{}</svg>\n",
      plane ? " plane" : "", width, std::ceil(height), escape(label), out_);
}

AskFigure::AskFigure(const Json& figure)
    : figure_(figure),
      unit_(shown_unit(text_of(figure, figure.contains("y_unit") ? "y_unit" : "unit"))),
      at_(numbers_of(figure, "at")) {
  std::sort(at_.begin(), at_.end());
  at_.erase(std::unique(at_.begin(), at_.end()), at_.end());
}

std::string AskFigure::value_title() const {
  return figure_.contains("measure") ? with_unit({text_of(figure_, "measure"), unit_}) : axis_title("x");
}

std::string AskFigure::axis_title(const char* axis) const {
  return with_unit({text_of(figure_, axis), shown_unit(text_of(figure_, (axis + std::string("_unit")).c_str()))});
}

std::string AskFigure::label_at(double value) const {
  return number_text(value, 7) + (unit_.empty() ? "" : " " + unit_);
}

double AskFigure::legend(std::vector<std::string> names, double top, bool boxes) {
  if (names.size() == 1 && names.front().empty()) names.clear();
  if (names.empty() && floor_.empty()) return top;
  double x = side, y = top + line_height;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<std::string> lines = wrapped(names[k], width - 2 * side - 2 * lane);
    const double wide = 2 * lane + width_of(lines.front());
    if (x > side && (x + wide > width - side || lines.size() > 1)) x = side, y += line_height;
    if (boxes)
      draw_.box(x, y - 9, 9, 9, fmt::format("part s{}", k % colours), "", colours_.empty() ? "" : colours_[k]);
    else if (k < lines_)
      draw_.line(x, y - dot, x + lane, y - dot, fmt::format("branch s{}", k % colours));
    else
      draw_.sign(x + dot, y - dot, signs_.empty() ? k : signs_[k - lines_]);
    for (std::size_t l = 0; l < lines.size(); ++l)
      draw_.text(x + 1.4 * lane, y + (l == 0 ? 0 : line_height) * static_cast<double>(l), lines[l]);
    x += wide + gap;
    if (lines.size() > 1)
      x = side,
      y += line_height * static_cast<double>(lines.size() - (k + 1 == names.size() && floor_.empty() ? 1 : 0));
  }
  if (!floor_.empty()) {
    if (x > side && x + 2 * lane + width_of(floor_) > width - side) x = side, y += line_height;
    draw_.line(x, y - dot, x + lane, y - dot, "floor s7");
    draw_.text(x + 1.4 * lane, y, floor_);
  }
  return y + gap;
}

double AskFigure::labels_at(const FigureAxis& axis, double top) {
  double end = top;
  std::vector<double> ends;  // of each line of labels, where its last one ends
  for (const double value : at_) {
    const std::string words = label_at(value);
    const double wide = width_of(words), x = std::clamp(axis.at(value) - wide / 2, side / 2, width - side / 2 - wide);
    std::size_t row = 0;
    while (row < ends.size() && ends[row] + gap > x) ++row;
    if (row == ends.size()) ends.push_back(0);
    ends[row] = x + wide;
    const double y = top + line_height * static_cast<double>(row + 1);
    draw_.text(x + wide / 2, y, words, "at", "middle");
    end = std::max(end, y + 4);
  }
  return end;
}

void AskFigure::ticks(const FigureAxis& axis, double top, double y, bool above) {
  double end = -1;
  for (const auto& [value, words] : axis.ticks()) {
    // Letters are a tenth wider on a phone.
    const double x = axis.at(value), wide = width_of(words), room = wide / 10,
                 from = std::clamp(x - wide / 2, room, width - wide - room);
    draw_.line(x, top, x, y, "grid");
    if (from <= end) continue;
    draw_.text(from + wide / 2, above ? y - 4 : y + line_height - 1, words, "tick", "middle");
    end = from + wide + 2;
  }
}

double AskFigure::title(const std::string& words, double y, bool logarithms) {
  for (const std::string& one : wrapped(words + (logarithms ? ", logarithmic" : ""), width - 2 * side)) {
    y += line_height;
    draw_.text(width / 2, y, one, "title", "middle");
  }
  return y + gap;
}

}  // namespace ricochet::report::ask_figures
