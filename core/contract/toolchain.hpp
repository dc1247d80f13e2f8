#pragma once

/// \file
/// What a compiler must be told before it reads any other header of the contract.
#if __cplusplus < 202002L
#error "Ricochet plugins need C++20: compile through the CMake target Ricochet::plugin, or with -std=c++20"
#endif
#ifndef EIGEN_MAX_ALIGN_BYTES
#error "Ricochet plugins share Eigen's alignment with the program: compile through the CMake target Ricochet::plugin"
#endif
