#include "framework/data/measurement/files/make_table.hpp"

#include <set>

#include "framework/data/measurement/files/table_builder.hpp"
#include "framework/experiment/column_spec.hpp"

namespace twinmap {

Table makeTable(const std::string& source, const std::vector<NamedColumn>& columns,
                const std::vector<std::string>& wanted, MissingCells missing) {
  TableBuilder table(source, wanted, missing);
  std::set<std::string> names;
  for (const NamedColumn& column : columns) {
    const ColumnSpec header = parseColumn(column.header);
    if (!names.insert(header.name).second) {
      throw MeasurementError(source + ": names the column '" + header.name + "' twice");
    }
    if (table.takes(header.name)) {
      table.reserve(static_cast<std::size_t>(column.values.size()));
      table.add({header.name, header.unit, column.values});
    }
  }
  return table.finish();
}

}  // namespace twinmap
