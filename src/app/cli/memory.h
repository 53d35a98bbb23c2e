// How much memory there is and how much was used.
#pragma once

namespace nephroid::cli {

/// Largest resident memory of this process since it was last reset, MiB; of its whole life where the system cannot
/// reset it.
double readPeakMemory();
void resetPeakMemory();

/// What the system can still give without swapping, MiB; infinite where it does not say.
double readAvailableMemory();

/// Refuses work that cannot fit. Linux grants memory that it does not have and kills the program when it is used: no
/// exception would ever tell the user what to do.
/// @param needed     a lower bound, MiB
/// @param available  MiB
/// @throws ResourceError with the sizes and what to lower
void checkMemory(double needed, double available);

}  // namespace nephroid::cli
