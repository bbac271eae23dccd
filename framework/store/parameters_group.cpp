#include "framework/store/parameters_group.hpp"

#include <stdexcept>

namespace twinmap {

void writeParametersGroup(Hdf5Writer& file, const std::string& group,
                          const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> names, units;
  Eigen::VectorXd lower(parameters.size()), upper(parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    names.push_back(parameters[p].name.text);
    units.push_back(parameters[p].unit);
    lower[static_cast<Eigen::Index>(p)] = parameters[p].bounds.lower;
    upper[static_cast<Eigen::Index>(p)] = parameters[p].bounds.upper;
  }
  file.write(group + "/name", names);
  file.write(group + "/unit", units);
  file.write(group + "/lower", lower);
  file.write(group + "/upper", upper);
}

std::vector<ParameterSpec> readParametersGroup(const Hdf5Reader& file, const std::string& group) {
  const std::vector<std::string> names = file.readTexts(group + "/name");
  const std::vector<std::string> units = file.readTexts(group + "/unit");
  const Eigen::VectorXd lower = file.readVector(group + "/lower");
  const Eigen::VectorXd upper = file.readVector(group + "/upper");
  const auto count = static_cast<Eigen::Index>(names.size());
  if (units.size() != names.size() || lower.size() != count || upper.size() != count) {
    throw std::runtime_error(file.getPath() + ": " + group + " does not describe each parameter");
  }
  std::vector<ParameterSpec> parameters(names.size());
  for (std::size_t p = 0; p < names.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    parameters[p].name.text = names[p];
    parameters[p].unit = units[p];
    parameters[p].bounds = {lower[row], upper[row], {}};
  }
  return parameters;
}

}  // namespace twinmap
