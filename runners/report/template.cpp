#include "runners/report/template.hpp"

#include <stdexcept>

#include "runners/report/assets.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {

std::string filled(std::string_view name, const Fill& with) {
  const std::string_view text = asset("templates/" + std::string(name) + ".html");
  kainjow::mustache::mustache made{std::string(text)};
  if (text.empty() || !made.is_valid())
    throw std::logic_error("template " + std::string(name) + ": " + (text.empty() ? "absent" : made.error_message()));
  made.set_custom_escape([](const std::string& raw) { return escape(raw); });
  return made.render(with);
}

}  // namespace ricochet::report
