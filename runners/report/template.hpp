#pragma once
#include <kainjow/mustache.hpp>
#include <string>
#include <string_view>

namespace ricochet::report {

/// What a template is filled with: texts, truth values, lists and objects of these.
using Fill = kainjow::mustache::data;

/// The template of templates/NAME.html, filled: {{x}} is escaped, {{{x}}} is HTML already.
std::string filled(std::string_view name, const Fill& with);

}  // namespace ricochet::report
