#pragma once

/// Calls of operator new so far in this program, shared libraries included.
long allocations();
