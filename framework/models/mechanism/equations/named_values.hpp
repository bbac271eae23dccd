#pragma once

#include "framework/experiment/expression/named_values.hpp"
#include "framework/models/mechanism/equations/algebra.hpp"

namespace twinmap::equations {

/// Named values that give vectors, too.
template <class S>
class NamedValues : public twinmap::NamedValues<S> {
 public:
  Vec3<S> calc3(const Expression3& expressions) const {
    return {this->calc(expressions[0]), this->calc(expressions[1]), this->calc(expressions[2])};
  }
};

}  // namespace twinmap::equations
