#include "framework/data/measurement/files/read_mat_table.hpp"

#include <matio.h>

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

/// What keeps a variable from being columns; "" if nothing does.
std::string findProblem(const matvar_t& variable) {
  const bool numeric = variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
  if (variable.class_type == MAT_C_OBJECT || variable.class_type == MAT_C_OPAQUE) {
    return "is an object, such as a timetable or a timeseries; save its columns: t = seconds(TT.Time); x = "
           "TT.x";
  }
  if (!numeric || variable.isLogical != 0) {
    return "is not an array of numbers";
  }
  if (variable.isComplex != 0) {
    return "is complex; must be real";
  }
  return variable.rank > 2 ? "has more than two dimensions" : "";
}

bool isVector(const matvar_t& variable) {
  return variable.rank < 2 || variable.dims[0] <= 1 || variable.dims[1] <= 1;
}

std::size_t countElements(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) {
    count *= variable.dims[i];
  }
  return count;
}

/// "log(:,2)", as MATLAB calls it.
std::string nameColumn(const std::string& name, std::size_t column) {
  return name + "(:," + std::to_string(column + 1) + ")";
}

/// One variable of a file, or a field of one: its header, and what reads its numbers.
class MatColumns {
 public:
  MatColumns(mat_t& file, TableBuilder& table) : file_(file), table_(table) {}

  void add(const matvar_t& variable) {
    const std::string name = variable.name;
    if (variable.class_type == MAT_C_STRUCT) {
      if (table_.wantsAnyOf(name + ".")) {
        addFields(name, *read(variable));
      }
    } else if (const std::string problem = findProblem(variable); !problem.empty()) {
      if (table_.takes(name)) {
        table_.skip(name, problem);
      }
    } else if (takesAny(name, variable)) {
      const MatVariable numbers = countElements(variable) == 0 ? nullptr : read(variable);
      addNumbers(name, variable, numbers.get());
    }
  }

 private:
  MatVariable read(const matvar_t& variable) {
    MatVariable numbers(Mat_VarRead(&file_, variable.name));
    if (numbers == nullptr) {
      throw MeasurementError(table_.getSource() + ": '" + variable.name +
                             "' cannot be read; is the file damaged?");
    }
    return numbers;
  }

  /// Of a vector or of any column of an array. An array that is asked for as a whole is an error.
  bool takesAny(const std::string& name, const matvar_t& variable) {
    if (isVector(variable)) {
      return table_.takes(name);
    }
    if (table_.isWanted(name)) {
      table_.skip(name, "must be a vector, or one of its columns: '" + nameColumn(name, 0) + "'");
    }
    bool any = false;
    for (std::size_t j = 0; j < variable.dims[1]; ++j) {
      any = table_.takes(nameColumn(name, j)) || any;
    }
    return any;
  }

  void addNumbers(const std::string& name, const matvar_t& variable, const matvar_t* read) {
    const std::size_t count = countElements(variable);
    if (count > 0 && (read == nullptr || read->data == nullptr)) {
      table_.skip(name, "cannot be read; is the file damaged?");
      return;
    }
    const Eigen::VectorXd values = count == 0 ? Eigen::VectorXd() : getValues(*read, count);
    if (isVector(variable)) {
      table_.reserve(count);
      table_.add({name, {}, values});
      return;
    }
    const auto rows = static_cast<Eigen::Index>(variable.dims[0]);
    for (std::size_t j = 0; j < variable.dims[1]; ++j) {
      if (table_.isWanted(nameColumn(name, j)) || table_.wantsAll()) {
        table_.reserve(variable.dims[0]);
        table_.add({nameColumn(name, j), {}, values.segment(static_cast<Eigen::Index>(j) * rows, rows)});
      }
    }
  }

  /// Fields of a single structure, "log.x", as a timeseries is saved by struct(ts).
  void addFields(const std::string& name, matvar_t& structure) {
    if (countElements(structure) != 1) {
      if (table_.takes(name)) {
        table_.skip(name, "is an array of structures");
      }
      return;
    }
    char* const* names = Mat_VarGetStructFieldnames(&structure);
    for (unsigned i = 0; i < Mat_VarGetNumberOfFields(&structure); ++i) {
      matvar_t* field = Mat_VarGetStructFieldByIndex(&structure, i, 0);
      const std::string whole = name + "." + names[i];
      if (field == nullptr) {
        continue;
      }
      if (field->class_type == MAT_C_STRUCT) {
        addFields(whole, *field);
      } else if (const std::string problem = findProblem(*field); !problem.empty()) {
        if (table_.takes(whole)) {
          table_.skip(whole, problem);
        }
      } else if (takesAny(whole, *field)) {
        addNumbers(whole, *field, field);
      }
    }
  }

  mat_t& file_;
  TableBuilder& table_;
};

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
  MatColumns columns(*file, table);
  for (const MatVariable& variable : variables) {
    if (variable->name != nullptr) {
      columns.add(*variable);
    }
  }
  return table.finish();
}

}  // namespace twinmap
