#include <ricochet/engine/active_system.hpp>

namespace ricochet {

void ActiveSystem::reserve(int most) {
  capacity = static_cast<std::size_t>(most);
  points.reserve(capacity);
  matrix.resize(capacity * capacity);
  right.resize(capacity);
  slopes.resize(capacity);
}

void ActiveSystem::factorise() {
  // A pivot this small against its diagonal belongs to a point that depends on those before it.
  constexpr double dependent = 1e-13;
  const std::size_t size = points.size();
  for (std::size_t i = 0; i < size; ++i) {
    const double diagonal = at(i, i);
    for (std::size_t j = 0; j < i; ++j) {
      double sum = at(i, j);
      for (std::size_t l = 0; l < j; ++l) sum -= at(i, l) * at(j, l) * at(l, l);
      at(i, j) = at(j, j) != 0 ? sum / at(j, j) : 0.0;
      at(i, i) -= at(i, j) * at(i, j) * at(j, j);
    }
    if (!(at(i, i) > dependent * diagonal)) at(i, i) = 0;
  }
}

void ActiveSystem::solve() {
  const std::size_t size = points.size();
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t l = 0; l < i; ++l) right[i] -= at(i, l) * right[l];
  for (std::size_t i = size; i-- > 0;) {
    right[i] = at(i, i) != 0 ? right[i] / at(i, i) : 0.0;
    for (std::size_t l = i + 1; l < size; ++l) right[i] -= at(l, i) * right[l];
  }
}

}  // namespace ricochet
