#pragma once
#include <ricochet/contract/contact_law.hpp>
#include <vector>

namespace ricochet {

/// Where contact points stand when the force of a compliant law is asked: m × lanes, lanes contiguous; bounds as the
/// law sees them, its layer included.
struct StandingPoints {
  int points = 0, lanes = 0;
  const double* place = nullptr;
  const double *lower = nullptr, *upper = nullptr;
  const double* rate = nullptr;  ///< null: at rest
  double* memory = nullptr;      ///< of the law, which it may change; null: one that has seen nothing, and is not kept
};

/// The efforts p (m × lanes, N) of a compliant law that was sized for these points, whatever moves them; zero in a lane
/// where it has none that is finite. For set-up: allocates.
std::vector<double> standing_force(ContactLaw& law, const StandingPoints& at);

}  // namespace ricochet
