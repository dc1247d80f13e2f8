#pragma once
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <map>
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

/// The statements of a database by their texts, each prepared when it is first asked for. One is used until it is asked
/// for again.
class Statements {
 public:
  explicit Statements(SQLite::Database& database) : database_(database) {}
  SQLite::Statement& of(const std::string& sql) { return known_.try_emplace(sql, database_, sql).first->second; }

 private:
  SQLite::Database& database_;
  std::map<std::string, SQLite::Statement> known_;
};

/// Executes a statement whose parameters are these.
template <class... Values>
void insert(SQLite::Statement& statement, const Values&... values) {
  statement.reset();
  int index = 0;
  (bind_value(statement, ++index, values), ...);
  statement.exec();
}

}  // namespace ricochet
