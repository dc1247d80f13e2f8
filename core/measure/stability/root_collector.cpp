#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/measure/stability/root_collector.hpp>

namespace ricochet {
namespace {

// The larger modulus of e^{λh}, mλ² + cλ + k = 0: what time h leaves of the motion; 0 where nothing moves by itself.
double physical_modulus(double m, double c, double k, double h) {
  if (m <= 0) return c > 0 ? std::exp(-k * h / c) : 0.0;
  const double discriminant = c * c - 4 * m * k;
  if (discriminant < 0) return std::exp(-0.5 * c * h / m);
  const double sum = c + std::sqrt(discriminant);
  return sum > 0 ? std::exp(-2 * k * h / sum) : 1.0;
}

}  // namespace

std::string root_text(std::complex<double> root) {
  const double near = 1e-6;
  if (std::abs(root - 1.0) < near) return "root +1";
  if (std::abs(root + 1.0) < near) return "root −1";
  if (std::abs(root.real()) < near) return "roots ±i";
  return fmt::format("roots of modulus 1 at ±{:.4g}°", std::abs(std::arg(root)) * 180 / std::numbers::pi);
}

void RootCollector::largest(const Root& root, double pulsation, bool on_kernel, const std::string& mode) {
  const double size = std::abs(root.value);
  // Of equal moduli the first is told: slow modes of an undamped structure all have modulus one.
  if (size <= spectrum.radius * (1 + 1e-12)) return;
  spectrum.radius = size;
  spectrum.root = root.value;
  spectrum.pulsation = pulsation;
  spectrum.on_kernel = on_kernel;
  spectrum.mode = mode;
}

void RootCollector::judge(const Root& root, double m, double c, double k, int others, double tolerance, RootPlace place,
                          const std::string& where) {
  const double size = std::abs(root.value);
  if (size < 1 - tolerance || size > 1 + growth_tolerance) return;
  const double physical = physical_modulus(m, c, k, h_);
  if (physical >= 1 - 10 * tolerance) {
    // A motion that neither decays nor lacks inertia has two roots on the circle, which meet at +1 as h → 0.
    if (std::abs(root.value - 1.0) < 1e-3) return;
    if (!root.defective && others <= 2) return;
    name(root, place, where);
  } else {
    name(root, place, where + (m > 0 ? ", though the structure is damped" : ""));
  }
}

void RootCollector::name(const Root& root, RootPlace place, const std::string& where) {
  spectrum.grows_linearly = spectrum.grows_linearly || root.defective;
  for (MarginalRoot& finding : spectrum.marginal_roots)
    if (finding.where == where && finding.defective == root.defective &&
        std::min(std::abs(finding.value - root.value), std::abs(finding.value - std::conj(root.value))) < 1e-6) {
      finding.count += std::abs(finding.value - root.value) < 1e-6;
      return;
    }
  spectrum.marginal_roots.push_back({root.value, place, where, root.defective, 1});
}

StepSpectrum RootCollector::finish(const std::string& contact) {
  spectrum.contact = contact;
  const std::vector<MarginalRoot>& findings = spectrum.marginal_roots;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const MarginalRoot& finding = findings[i];
    if (!spectrum.marginal.empty()) spectrum.marginal += "; ";
    if (i == most_findings) {
      spectrum.marginal += fmt::format("and {} more", findings.size() - i);
      break;
    }
    spectrum.marginal += finding.defective ? "double " : "";
    spectrum.marginal += root_text(finding.value) + " on " + finding.where;
    if (finding.count > 1) spectrum.marginal += fmt::format(" ({} times)", finding.count);
    if (finding.defective) spectrum.marginal += ": grows linearly";
  }
  return std::move(spectrum);
}

}  // namespace ricochet
