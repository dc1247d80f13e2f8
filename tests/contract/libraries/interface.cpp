// All that a plugin includes, compiled with its debug information: tests/contract_layout.py reads it.
#include <ricochet/contract/plugin.hpp>
