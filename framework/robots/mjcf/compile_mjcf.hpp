#pragma once

namespace twinmap::robots {

/// The Python program that compiles MJCF (compile_mjcf.py).
const char* getMjcfCompiler();

}  // namespace twinmap::robots
