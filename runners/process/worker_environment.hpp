#pragma once
#include <string>
#include <vector>

namespace ricochet {

/// The program that workers are: this one, found even where its file was replaced meanwhile; never one that is an MPI
/// rank.
const std::string& worker_program();

/// The environment variables of a worker, "NAME=value": those of this process without what a parallel launcher put
/// there for its own ranks, and with one thread for its BLAS where nothing else is said.
std::vector<std::string> worker_environment();

}  // namespace ricochet
