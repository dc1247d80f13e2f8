#pragma once
#include <string>
#include <vector>

#include "runners/report/figures.hpp"

/// \file
/// The pieces of ECharts options that all figures share. "@name" stands for a function of the page's script.
namespace ricochet::report {

/// An interval of an axis.
struct Interval {
  double low = 0, high = 0;
  bool empty() const { return !(low <= high); }
  static Interval nothing() { return {1, -1}; }
  void include(double value);
  void include(const Interval& other);
};

/// The interval rounded outwards to a round step of about five ticks, at least `least` wide.
Interval round_outwards(Interval interval, double least);
/// Rounded outwards to whole decades; needs 0 < low.
Interval whole_decades(Interval interval);

/// The intervals of small multiples, made equal so that they compare; one whose largest magnitude is over 4 times the
/// median one keeps its own, so that it does not flatten the others.
struct Frame {
  Interval range;
  bool own = false;
};
std::vector<Frame> shared_frames(const std::vector<Interval>& ranges);

/// Dash pattern number k as ECharts' lineStyle.type and as SVG's stroke-dasharray.
Json line_dash(size_t k);
std::string svg_dash(size_t k);
size_t dash_count();
/// Plot symbol number k.
std::string symbol(size_t k);

/// Colour mixed with white: share 0 keeps it, 1 is white.
std::string lighten(const std::string& colour, double share);

/// Legend symbol of a status: ✓ done, ⊘ refused, ✕ diverged, ! failed; the word itself for an unknown status.
std::string status_mark(const std::string& status);

/// Grid, tooltip, hidden legend, zoom and text style; `x` and `y` become the axes.
Json base_option(Json x, Json y, bool along_x, bool hover_items);
Json value_axis(const Quantity& quantity, const Interval& range, bool vertical);
Json log_axis(const Quantity& quantity, const Interval& range, bool vertical);

/// A series of one text mark per item ({"value": [x, y], "mark": "✕", "text": …}) that the legend filters with the
/// curve `name`.
Json mark_series(const std::string& name, const std::string& colour, Json items);

/// The sentences "refused, step 1e-6 s: why" of the cases that did not finish, those with the same reason put together.
std::vector<std::string> outcome_notes(const CaseView& view, const Cases& cases,
                                       const std::vector<std::string>& columns);

}  // namespace ricochet::report
