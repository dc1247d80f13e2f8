#pragma once
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"

/// \file
/// What verbs that kinds of study answer have in common.
namespace ricochet::asks {

inline constexpr double per_cent = 100;  ///< rows and figures have shares in per cent

/// The first of these sentences that has at most thirty words; the last where none has. The fullest stands first.
std::string fitting(const std::vector<std::string>& sentences);

/// An entry of `ask` whose verb stands at `pointer`, "/ask/0/order".
Ask ask_at(const Json& keys, const std::string& pointer);

/// Refuses stops, of which such a verb does not speak.
void refuse_stops(const Ask& ask);

/// Columns of these cases that vary, refinements among them.
std::vector<std::string> varying(const Evidence& evidence, const Cases& cases);

/// What is told of the cases of an ask that have no such value, as Answered::aside.
void leave_out(Answered& out, const std::vector<std::string>& reasons);
/// The same of cases, counted by status and reason; those that differ in numbers alone are one.
void leave_out(Answered& out, const Cases& left);

}  // namespace ricochet::asks
