#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runners/report/figure_axis.hpp"

/// \file
/// What figures of asks are drawn with.
namespace ricochet::report::ask_figures {

using Json = nlohmann::ordered_json;

// Units of the drawing are pixels of a phone; a wide screen draws it larger and its letters smaller.
inline constexpr double width = 400, letter = 12, line_height = 15, side = 8, glyph = 0.62 * letter;
inline constexpr double dot = 4, lane = 11, gap = 6;
inline constexpr int most_ticks = 5;
inline constexpr std::size_t colours = 8;
/// A factor between values from which a linear axis hides the small ones.
inline constexpr double wide_range = 300;

double width_of(const std::string& text);
/// Words in lines that are no wider.
std::vector<std::string> wrapped(const std::string& text, double most);

// What a specification has under a key; nothing where it is of another type.
std::string text_of(const Json& object, const char* key);
std::optional<double> number_of(const Json& object, const char* key);
std::vector<double> numbers_of(const Json& object, const char* key);
const Json& list_of(const Json& object, const char* key);

/// A value with its interval.
struct Mark {
  std::optional<double> value, low, high;
  explicit Mark(const Json& row);
  void add_to(std::vector<double>& all) const;
};

/// "HRZ: 97.03 (96.97 to 97.1)".
std::string words_of(const std::string& name, const Mark& mark, const std::string& unit);

/// SVG, piece by piece. What is drawn later lies above. Series have a colour each, and of one colour a shape.
class Drawing {
 public:
  void line(double x1, double y1, double x2, double y2, const std::string& classes);
  /// `colour`: "#0072B2", where it is none of the series'.
  void box(double x, double y, double w, double h, const std::string& classes, const std::string& title = "",
           const std::string& colour = "");
  /// `anchor`: "start", "middle" or "end"; y of the base line.
  void text(double x, double y, const std::string& words, const std::string& classes = "",
            const char* anchor = "start");
  /// The sign of a series.
  void sign(double x, double y, std::size_t series, const std::string& title = "");
  void path(const std::string& d, const std::string& classes, const std::string& title = "");
  /// From low to high, at a place `across`; upright where values are.
  void whisker(double low, double high, double across, bool upright, std::size_t series);
  /// The whole, so high; `plane`: of few rows, that are seen together.
  std::string svg(double height, const std::string& label, bool plane = false) const;

 private:
  std::string out_;
};

/// What figures of all forms have: an axis title, lines `at` that are labelled, a legend.
class AskFigure {
 public:
  explicit AskFigure(const Json& figure);
  virtual ~AskFigure() = default;
  AskFigure(const AskFigure&) = delete;
  AskFigure& operator=(const AskFigure&) = delete;
  virtual std::string svg() = 0;

 protected:
  /// "peak force (N)"; of what has no measure that of `x`.
  std::string value_title() const;
  /// "step (s)" of `x` and `x_unit`.
  std::string axis_title(const char* axis) const;
  /// Names of series with their signs, from `top` downwards; where it ends. Boxes have the colours of colours_ where
  /// these are given.
  double legend(std::vector<std::string> names, double top, bool boxes = false);
  /// "60 N".
  std::string label_at(double value) const;
  /// The labels of upright lines at values, below `top`; where they end.
  double labels_at(const FigureAxis& axis, double top);
  /// The ticks of a horizontal axis, with lines up to `top`; words below y, or above it.
  void ticks(const FigureAxis& axis, double top, double y, bool above = false);
  /// A title below an axis; where it ends.
  double title(const std::string& words, double y, bool logarithms);

  const Json& figure_;
  std::string unit_;
  std::vector<double> at_;
  std::string floor_;                 ///< what the legend calls the dashed lines of floors; "" where there are none
  std::size_t lines_ = 0;             ///< so many names of a legend are those of lines
  std::vector<std::size_t> signs_;    ///< the series whose signs stand for the other names; empty: their places
  std::vector<std::string> colours_;  ///< of the names of a legend; empty: those of series
  Drawing draw_;
};

// The figures of rows and those of a plane; "" of another form.
std::string row_figure(const std::string& form, const Json& figure);
std::string plane_figure(const std::string& form, const Json& figure);

}  // namespace ricochet::report::ask_figures
