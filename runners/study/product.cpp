#include "runners/study/product.hpp"

#include <fmt/format.h>

namespace ricochet {

void Product::refuse_above(std::size_t limit, const std::string& pointer) const {
  if (count() > static_cast<double>(limit))
    throw InputError(
        pointer,
        fmt::format(
            "the lists multiply to {:.10g} combinations; expected at most {}: shorten a list or split the study",
            count(), limit));
}

}  // namespace ricochet
