#pragma once

namespace ricochet {

/// The life of a worker: opens the study that it is sent, then does what it is asked to, case by case, until the other
/// end of its channel closes. What cases keep and look for is the coordinator's. Returns its exit code; ends the
/// process itself where a plugin's function does not come back.
int serve_as_worker();

}  // namespace ricochet
