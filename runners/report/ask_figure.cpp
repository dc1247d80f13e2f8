#include "runners/report/ask_figure.hpp"

#include "runners/report/figure_drawing.hpp"

namespace ricochet::report {

std::string figure_svg(const nlohmann::ordered_json& figure) {
  if (!figure.is_object()) return "";
  const std::string form = ask_figures::text_of(figure, "form"), rows = ask_figures::row_figure(form, figure);
  return rows.empty() ? ask_figures::plane_figure(form, figure) : rows;
}

}  // namespace ricochet::report
