#pragma once

/// Fused multiply-adds per nanosecond that this core reaches now: ten independent chains of vector operations on
/// registers, best of several short runs. 0 where the processor has no FMA.
double fma_peak();
