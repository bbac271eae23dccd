#pragma once

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"

namespace twinmap {

/// A frame fixed to a body: its origin and its orientation as body-fixed x-y-z angles (rad).
struct FrameSpec {
  Expression3 point;
  Expression3 orientation;
};

template <class Fields>
void describe(Fields& f, FrameSpec& s) {
  f.optional("point", s.point, "origin of the frame, in the body's frame", Unit{"m"});
  f.optional("orientation", s.orientation, "body-fixed x-y-z angles", Unit{"rad"});
}

}  // namespace twinmap
