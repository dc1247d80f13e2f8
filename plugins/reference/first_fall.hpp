#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

/// \file
/// When a smooth function first falls below zero: the search for contact events, impacts and releases alike.
namespace ricochet::reference {

/// A function read at one time: its value and its rate.
struct Reading {
  double at = 0, value = 0, rate = 0;
};

/// The zero of `read` between `above` (value ≥ 0, or rising from a value of round-off) and `below` (value < 0): Newton
/// kept inside its bracket, to the last digit of the time.
template <class Function>
double crossing(const Function& read, Reading above, Reading below) {
  double left = above.at, right = below.at;
  Reading now = std::abs(above.value) < std::abs(below.value) ? above : below;
  for (int k = 0; k < 200; ++k) {
    const double newton = now.rate != 0 ? now.at - now.value / now.rate : right;
    const double middle = left + (right - left) / 2;
    const bool inside = newton > left && newton < right && k % 8 != 7;
    const double next = inside ? newton : middle;
    if (next <= left || next >= right || next == now.at) break;
    now = read(next);
    (now.value >= 0 ? left : right) = next;
    if (now.value == 0) break;
  }
  return left;
}

/// The time in [a, b] where the rate changes its sign.
template <class Function>
Reading turning(const Function& read, Reading a, Reading b) {
  const bool rises = a.rate > 0;
  for (int k = 0; k < 200; ++k) {
    const double middle = a.at + (b.at - a.at) / 2;
    if (middle <= a.at || middle >= b.at) break;
    const Reading now = read(middle);
    ((now.rate > 0) == rises ? a : b) = now;
  }
  return rises ? (a.value > b.value ? a : b) : (a.value < b.value ? a : b);
}

/// The first time in [a, b] where the function passes from at least zero to below −noise; none when it does not.
/// `curve` bounds |f''| there: a chord lies above the function by at most curve·(b − a)²/8, so most intervals are
/// dismissed unread. Others are halved `depth` times; the last ones are taken to turn once at most. A function that
/// starts at zero and falls is there already; one that starts at zero and rises must come back first.
template <class Function>
std::optional<double> first_fall(const Function& read, const Reading& a, const Reading& b, double curve, double noise,
                                 int depth) {
  const double width = b.at - a.at;
  if (std::min(a.value, b.value) > curve * width * width / 8) return std::nullopt;
  if (depth > 0) {
    const Reading middle = read(a.at + width / 2);
    if (auto found = first_fall(read, a, middle, curve, noise, depth - 1)) return found;
    return first_fall(read, middle, b, curve, noise, depth - 1);
  }
  Reading below = b;
  if (below.value >= -noise) {
    if (a.rate >= 0 || b.rate <= 0) return std::nullopt;
    below = turning(read, a, b);
    if (below.value >= -noise) return std::nullopt;
  }
  Reading above = a;
  if (above.value <= 0) {
    if (above.rate <= 0 || below.rate >= 0) return above.at;
    above = turning(read, a, below);
    if (above.value <= 0) return a.at;
  }
  return crossing(read, above, below);
}

}  // namespace ricochet::reference
