#pragma once

namespace ricochet {

/// Bytes that this process may still take without paging: what the machine has free, less where the process or its
/// group is allowed less; infinite where nobody says.
double available_memory();

}  // namespace ricochet
