// What is called rarely, and kept out of the way of what is called often.
#pragma once

#if defined(__GNUC__)
#define TINSMITH_RARE __attribute__((noinline, cold))
#else
#define TINSMITH_RARE
#endif
