#include "framework/data/measurement/files/read_mat_table.hpp"

#include <matio.h>

#include <algorithm>
#include <memory>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/measurement/files/table_builder.hpp"

namespace twinmap {
namespace {

struct CloseFile {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseFile>;
using MatVariable = std::unique_ptr<matvar_t, FreeVariable>;

template <class Number>
Eigen::VectorXd convert(const matvar_t& variable, std::size_t count) {
  using Numbers = Eigen::Matrix<Number, Eigen::Dynamic, 1>;
  return Eigen::Map<const Numbers>(static_cast<const Number*>(variable.data), count).template cast<double>();
}

Eigen::VectorXd getValues(const matvar_t& variable, std::size_t count) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return convert<double>(variable, count);
    case MAT_C_SINGLE:
      return convert<float>(variable, count);
    case MAT_C_INT8:
      return convert<std::int8_t>(variable, count);
    case MAT_C_UINT8:
      return convert<std::uint8_t>(variable, count);
    case MAT_C_INT16:
      return convert<std::int16_t>(variable, count);
    case MAT_C_UINT16:
      return convert<std::uint16_t>(variable, count);
    case MAT_C_INT32:
      return convert<std::int32_t>(variable, count);
    case MAT_C_UINT32:
      return convert<std::uint32_t>(variable, count);
    case MAT_C_INT64:
      return convert<std::int64_t>(variable, count);
    default:
      return convert<std::uint64_t>(variable, count);
  }
}

/// What keeps a variable from being a column; "" if nothing does.
std::string findProblem(const matvar_t& variable) {
  const bool numeric = variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
  if (!numeric || variable.isLogical != 0) {
    return "is not an array of numbers";
  }
  if (variable.isComplex != 0) {
    return "is complex; must be real";
  }
  const std::size_t* begin = variable.dims;
  const std::size_t* end = begin + variable.rank;
  const auto longer = std::count_if(begin, end, [](std::size_t n) { return n != 1; });
  return longer > 1 && std::find(begin, end, std::size_t{0}) == end
             ? "must be a vector, with one row or one column"
             : "";
}

std::size_t countElements(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) {
    count *= variable.dims[i];
  }
  return count;
}

void addVariable(mat_t& file, matvar_t& variable, TableBuilder& table) {
  const std::string name = variable.name;
  const std::string problem = findProblem(variable);
  if (!problem.empty()) {
    table.skip(name, problem);
    return;
  }
  const std::size_t count = countElements(variable);
  table.reserve(count);
  const MatVariable read(count == 0 ? nullptr : Mat_VarRead(&file, name.c_str()));
  if (count > 0 && (read == nullptr || read->data == nullptr)) {
    table.skip(name, "cannot be read; is the file damaged?");
  } else {
    table.add({name, {}, count == 0 ? Eigen::VectorXd() : getValues(*read, count)});
  }
}

}  // namespace

Table readMatTable(const std::filesystem::path& path, const std::vector<std::string>& wanted,
                   MissingCells missing) {
  const auto library = lockHdf5();
  const MatFile file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (file == nullptr) {
    throw MeasurementError(path.string() + ": cannot be read as a MATLAB file");
  }
  TableBuilder table(path.string(), wanted, missing);
  std::vector<MatVariable> variables;
  while (matvar_t* variable = Mat_VarReadNextInfo(file.get())) {
    variables.emplace_back(variable);
  }
  for (const MatVariable& variable : variables) {
    if (variable->name != nullptr && table.takes(variable->name)) {
      addVariable(*file, *variable, table);
    }
  }
  return table.finish();
}

}  // namespace twinmap
