#pragma once
#include <SQLiteCpp/Statement.h>

#include <string>

#include "runners/table/text.hpp"

namespace ricochet {

// Texts are read where they stand: they live until the row is there.
inline void bind_value(SQLite::Statement& statement, int index, const std::string& text) {
  if (is_plain(text))
    statement.bindNoCopy(index, text);
  else
    statement.bind(index, plain_text(text));
}
inline void bind_value(SQLite::Statement& statement, int index, const char* text) {
  statement.bindNoCopy(index, text);
}
void bind_value(SQLite::Statement& statement, int index, auto number) {
  statement.bind(index, number);
}

/// Executes a statement whose parameters are these.
template <class... Values>
void insert(SQLite::Statement& statement, const Values&... values) {
  statement.reset();
  int index = 0;
  (bind_value(statement, ++index, values), ...);
  statement.exec();
}

}  // namespace ricochet
