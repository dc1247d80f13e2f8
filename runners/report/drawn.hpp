#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::report {

/// What the report of a kind draws, and what its page must hold for that.
struct Drawn {
  std::vector<std::string_view>
      scripts;  ///< of report/figures, in the page's order; what figures share goes before them
  std::vector<std::string_view> tables;      ///< derived tables that they read
  std::vector<std::string_view> own_tables;  ///< tables of single cases
  std::vector<std::string_view> curves;      ///< columns of the sampled curves, over t
  bool orbits = false, basins = false;       ///< section points and portraits; images of cells
};

/// Every kind has the figures of effects; one that is not known has these alone.
const Drawn& drawn_for(std::string_view kind);

}  // namespace ricochet::report
