#include "runners/report/figure_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

constexpr double ten = 10;

/// The least of 1, 2 and 5 times a power of ten that is no less.
double round_up(double value) {
  const double decade = std::pow(ten, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= value * (1 - 1e-12)) return digit * decade;
  return ten * decade;
}
double round_down(double value) {
  return 1 / round_up(1 / value);
}

/// A tick's text: all digits that its step has, no more.
std::string tick_text(double value, double step, double largest) {
  constexpr double many = 1e5, few = 1e-3;
  if (std::abs(value) < 1e-9 * step) return "0";
  if (largest >= many || largest < few) {
    const int digits = std::max(
        1, static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9) - std::floor(std::log10(step) + 1e-9)) + 1);
    return number_text(value, digits);
  }
  std::string text = fmt::format("{:.{}f}", value, std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9))));
  if (text[0] == '-') text.replace(0, 1, "−");
  return text;
}

/// 1, 2 and 5 times a power of ten: "0.02", "5e-5", the same on all of an axis.
std::string decade_text(double value) {
  constexpr double many = 1e5, few = 1e-3;
  if (value > few * (1 - 1e-9) && value < many) return number_text(value, 4);
  const double exponent = std::floor(std::log10(value) + 1e-9);
  return fmt::format("{:.0f}e{:.0f}", value / std::pow(ten, exponent), exponent);
}

}  // namespace

bool spans(const std::vector<double>& values, double factor) {
  if (values.empty()) return false;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *low > 0 && *high > factor * *low;
}

FigureAxis::FigureAxis(const std::vector<double>& values, bool logarithms, double from, double to, int most)
    : logarithms_(logarithms), from_(from), to_(to) {
  if (!values.empty()) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    low_ = *low;
    high_ = *high;
  } else if (logarithms) {
    low_ = high_ = 1;
  }
  if (logarithms)
    round_logarithms(most);
  else
    round_linear(most);
}

void FigureAxis::round_linear(int most) {
  // Of one value alone something to each side; of what doubles cannot divide, too.
  const double least = 1e-6 * std::max(std::abs(low_), std::abs(high_));
  if (high_ - low_ <= least) {
    const double more = low_ == 0 && high_ == 0 ? 1 : 0.1 * std::max(std::abs(low_), std::abs(high_));
    low_ -= more;
    high_ += more;
  }
  for (double step = round_up((high_ - low_) / most);; step = round_up(1.5 * step)) {
    const double from = std::floor(low_ / step + 1e-9), to = std::ceil(high_ / step - 1e-9);
    if (to - from > most) continue;
    low_ = from * step;
    high_ = to * step;
    const double largest = std::max(std::abs(low_), std::abs(high_));
    for (double k = from; k <= to; ++k) ticks_.emplace_back(k * step, tick_text(k * step, step, largest));
    return;
  }
}

void FigureAxis::round_logarithms(int most) {
  low_ = round_down(low_);
  high_ = round_up(high_);
  if (high_ <= low_) low_ = round_down(low_ / 2), high_ = round_up(high_ * 2);
  const auto add = [&](double value) {
    if (value < low_ * (1 - 1e-9) || value > high_ * (1 + 1e-9)) return;
    ticks_.emplace_back(value, decade_text(value));
  };
  const int first = static_cast<int>(std::floor(std::log10(low_) + 1e-9)),
            last = static_cast<int>(std::ceil(std::log10(high_) - 1e-9));
  // Every decade with 1, 2 and 5, every decade, or every so many of them.
  const double decades = std::log10(high_ / low_);
  if (3 * decades <= most + 1) {
    for (int k = first; k <= last; ++k)
      for (const double digit : {1.0, 2.0, 5.0}) add(digit * std::pow(ten, k));
  } else {
    const int every = std::max(1, (last - first + most - 1) / most);
    for (int k = first; k <= last; k += every) add(std::pow(ten, k));
  }
}

double FigureAxis::at(double value) const {
  const double share = logarithms_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
  return from_ + share * (to_ - from_);
}

}  // namespace ricochet::report
