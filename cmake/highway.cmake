# Highway compiles its files once for each kind of vector. Not for that of SSSE3 alone: the few processors that have nothing newer take what
# all have (SSE2), and a quarter of those files' time to compile is saved.
find_package(hwy REQUIRED GLOBAL)
set_property(TARGET hwy::hwy APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS HWY_DISABLED_TARGETS=HWY_SSSE3)
