#pragma once
#include <string>
#include <vector>

#include "runners/report/figures.hpp"

namespace ricochet::report {

/// The cases of one method along an axis.
struct MethodCurve {
  std::string name, colour;
  size_t style = 0;  ///< dash and symbol
  Cases cases;       ///< sorted along the axis
};

/// One chart's methods.
struct MethodFacet {
  std::string title;
  Cases cases;
  std::vector<MethodCurve> curves;
};

/// Cases as curves along `along`, in facets of at most eight curves: first by `apart` (what must not share a chart),
/// then by what is no method, then by methods other than the mass matrix. Colour is the mass matrix; where a study has
/// one mass only, it is the curve.
class MethodCurves {
 public:
  MethodCurves(const CaseView& view, const Cases& cases, const std::string& along,
               const std::vector<std::string>& apart, const std::vector<std::string>& ignored);

  const std::vector<MethodFacet>& facets() const { return facets_; }
  /// Columns whose values tell a case of a facet apart: the axis, then those of the curves.
  const std::vector<std::string>& said() const { return said_; }
  std::vector<LegendEntry> legend() const;
  /// What the colours mean, for a caption.
  std::string colours_text() const;

 private:
  bool by_mass_;
  std::vector<MethodFacet> facets_;
  std::vector<std::string> said_;
};

}  // namespace ricochet::report
