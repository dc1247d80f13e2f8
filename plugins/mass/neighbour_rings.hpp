#pragma once
#include <algorithm>
#include <numeric>
#include <ricochet/contract/mass_strategy.hpp>
#include <vector>

namespace ricochet {

/// Contact dofs whose neighbourhoods overlap, and the dofs of these neighbourhoods.
struct DofGroup {
  std::vector<int> dofs;   ///< sorted
  std::vector<char> near;  ///< of each of the n dofs
};

/// Groups of contact dofs on the graph of K and M, whose neighbourhood are the dofs at most `reach` entries away; 0:
/// all dofs, one group.
inline std::vector<DofGroup> ring_groups(const GivenMass& given, const std::vector<int>& contact, int reach) {
  const auto n = static_cast<std::size_t>(given.mass.rows());
  if (contact.empty()) return {};
  if (reach == 0) return {{contact, std::vector<char>(n, 1)}};
  std::vector<std::vector<int>> rings;
  std::vector<std::size_t> group(contact.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto first_of = [&](std::size_t k) {
    while (group[k] != k) k = group[k];
    return k;
  };
  std::vector<int> owner(n, -1), met(n, -1);
  for (std::size_t k = 0; k < contact.size(); ++k) {
    const auto mine = static_cast<int>(k);
    std::vector<int>& ring = rings.emplace_back(1, contact[k]);
    met[static_cast<std::size_t>(contact[k])] = mine;
    std::size_t begin = 0;
    for (int step = 0; step < reach; ++step) {
      const std::size_t end = ring.size();
      for (; begin < end; ++begin)
        for (const SparseMatrix* graph : {&given.stiffness, &given.mass})
          for (SparseMatrix::InnerIterator it(*graph, ring[begin]); it; ++it)
            if (int& at = met[static_cast<std::size_t>(it.row())]; at != mine && it.value() != 0) {
              at = mine;
              ring.push_back(static_cast<int>(it.row()));
            }
    }
    for (const int dof : ring) {
      int& other = owner[static_cast<std::size_t>(dof)];
      if (other < 0) other = mine;
      const std::size_t a = first_of(k), b = first_of(static_cast<std::size_t>(other));
      group[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<DofGroup> out;
  std::vector<int> number(contact.size(), -1);
  for (std::size_t k = 0; k < contact.size(); ++k) {
    int& at = number[first_of(k)];
    if (at < 0) {
      at = static_cast<int>(out.size());
      out.push_back({{}, std::vector<char>(n, 0)});
    }
    DofGroup& one = out[static_cast<std::size_t>(at)];
    one.dofs.push_back(contact[k]);
    for (const int dof : rings[k]) one.near[static_cast<std::size_t>(dof)] = 1;
  }
  return out;
}

}  // namespace ricochet
