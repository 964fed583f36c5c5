# Highway compiles a kernel once per vector instruction set. The SSSE3 variant is disabled: processors without newer
# instructions use the SSE2 variant, and the kernels compile in three quarters of the time.
find_package(hwy REQUIRED GLOBAL)
set_property(TARGET hwy::hwy APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS HWY_DISABLED_TARGETS=HWY_SSSE3)
