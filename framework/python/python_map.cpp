#include "framework/python/python_map.hpp"

#include <stdexcept>

namespace twinmap::python {

const Inferrer& PythonMap::getTrained() const {
  if (source_.findTrained() == nullptr) {
    throw std::logic_error("an experiment alone has no map");
  }
  return *source_.findTrained();
}

PythonMap::Session PythonMap::borrow(const SessionOptions& options) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Session>& idle = idle_[options];
    if (!idle.empty()) {
      Session session = std::move(idle.back());
      idle.pop_back();
      return session;
    }
  }
  return source_.makeSession(options);
}

void PythonMap::giveBack(const SessionOptions& options, Session session) {
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_[options].push_back(std::move(session));
}

}  // namespace twinmap::python
