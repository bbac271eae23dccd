#include "bench/simulation/mujoco_simulation.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace twinmap::bench {
namespace {

/// MuJoCo would write them to a file; a solution that is lost shows in its error.
void ignoreWarning(const char*) {}

mjModel* loadModel(const std::string& file) {
  mju_user_warning = ignoreWarning;
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
  if (model == nullptr) {
    throw std::runtime_error(file + ": " + error.data());
  }
  return model;
}

/// What MuJoCo's callback sees of the simulation under way.
struct StageForces {
  const Mechanism* mechanism = nullptr;
  const Point* parameters = nullptr;
};
StageForces stage_forces;

void callStageForces(const mjModel*, mjData* data) {
  stage_forces.mechanism->applyStageForces(*stage_forces.parameters, *data);
}

}  // namespace

MujocoSimulation::MujocoSimulation(const Mechanism& mechanism, Eigen::VectorXd start,
                                   const Eigen::VectorXd& times)
    : mechanism_(mechanism),
      start_(std::move(start)),
      time_count_(times.size()),
      interval_(times[0]),
      model_(loadModel(mechanism.mjcf), mj_deleteModel),
      data_(mj_makeData(model_.get()), mj_deleteData) {
  if (model_->nq != start_.size()) {
    throw std::runtime_error(mechanism.mjcf + " has other coordinates than " + mechanism.experiment);
  }
}

Eigen::VectorXd MujocoSimulation::simulate(const Point& parameters, int steps) {
  mechanism_.update(parameters, *model_);
  model_->opt.timestep = interval_ / steps;
  mj_setConst(model_.get(), data_.get());
  mj_resetData(model_.get(), data_.get());
  Eigen::Map<Eigen::VectorXd> coordinates(data_->qpos, start_.size());
  coordinates = start_;
  stage_forces = {&mechanism_, &parameters};
  mjcb_control = mechanism_.applyStageForces != nullptr ? callStageForces : nullptr;
  Eigen::MatrixXd response(time_count_, start_.size());
  for (Eigen::Index i = 0; i < time_count_; ++i) {
    for (int j = 0; j < steps; ++j) {
      if (mechanism_.applyForces != nullptr) {
        // the middle of the step: edges of pulses lie between steps
        mechanism_.applyForces(parameters, interval_ * (i + (j + 0.5) / steps), *data_);
      }
      mj_step(model_.get(), data_.get());
    }
    response.row(i) = coordinates;
  }
  mjcb_control = nullptr;
  return response.reshaped();
}

}  // namespace twinmap::bench
