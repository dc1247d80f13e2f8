#pragma once
#include <optional>
#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

/// How much a contact law gives way, m/N: 0 for a rigid law; 1/κ of one that declares a constant stiffness κ; of any
/// other the secant d²/2U(d) of the energy U that it stores at the depth `depth` (m). Nothing for a compliant law that
/// says neither. It follows from the law alone, whatever its parameters are called. The law is prepared for one point.
std::optional<double> contact_compliance(ContactLaw& law, const Parameters& parameters, double depth);

}  // namespace ricochet
