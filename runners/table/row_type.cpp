#include "runners/table/row_type.hpp"

namespace ricochet {

void RowFields::add(Column column, Field field) {
  columns_.push_back(std::move(column));
  fields_.push_back(std::move(field));
}

Row RowFields::row_of(const void* record) const {
  Row row;
  row.reserve(fields_.size());
  for (const Field& field : fields_)
    row.push_back(field.form ? field.form->write(static_cast<const char*>(record) + field.offset)
                             : field.write(record));
  return row;
}

RowFields::Places RowFields::find(const Table& table) const {
  Places places;
  for (const auto& [name, field] : in_front_)
    if (const auto place = find_column(table.columns, name)) places.emplace_back(*place, &field);
  for (std::size_t k = 0; k < fields_.size(); ++k)
    if (const auto place = find_column(table.columns, columns_[k].name)) places.emplace_back(*place, &fields_[k]);
  return places;
}

void RowFields::read(const Row& row, const Places& places, void* record) {
  for (const auto& [place, field] : places)
    if (field->form)
      field->form->read(static_cast<char*>(record) + field->offset, row.at(place));
    else
      field->read(record, row.at(place));
}

}  // namespace ricochet
