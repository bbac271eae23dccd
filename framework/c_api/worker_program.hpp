#pragma once

namespace twinmap::c_api {

/// FMUs are simulated by processes of the twinmap command, as the program that uses the library can be none:
/// the one that was installed with this library, else the one in PATH. At the first call; from any thread.
void chooseWorkerProgram();

}  // namespace twinmap::c_api
