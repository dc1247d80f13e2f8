#pragma once

namespace ricochet {

/// Four numbers that may start at any of them. A typedef: in a using, clang leaves the alignment out.
typedef double LooseFour __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(LooseFour) == 8);

}  // namespace ricochet
