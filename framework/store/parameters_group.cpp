#include "framework/store/parameters_group.hpp"

namespace twinmap {

void writeParametersGroup(Hdf5Writer& file, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> names, units;
  Eigen::VectorXd lower(parameters.size()), upper(parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    names.push_back(parameters[p].name.text);
    units.push_back(parameters[p].unit);
    lower[static_cast<Eigen::Index>(p)] = parameters[p].bounds.lower;
    upper[static_cast<Eigen::Index>(p)] = parameters[p].bounds.upper;
  }
  file.write("/parameters/name", names);
  file.write("/parameters/unit", units);
  file.write("/parameters/lower", lower);
  file.write("/parameters/upper", upper);
}

std::vector<ParameterSpec> readParametersGroup(const Hdf5Reader& file) {
  const std::vector<std::string> names = file.readTexts("/parameters/name");
  const std::vector<std::string> units = file.readTexts("/parameters/unit");
  const Eigen::VectorXd lower = file.readVector("/parameters/lower");
  const Eigen::VectorXd upper = file.readVector("/parameters/upper");
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
