# How every target is compiled. kd_options carries the arithmetic contract (no contraction, so that the CPU and the GPU
# return the same bits), the warnings and the sanitizers.
include(CheckCXXCompilerFlag)

add_library(kd_options INTERFACE)
target_include_directories(kd_options INTERFACE ${PROJECT_SOURCE_DIR}/libkd)
target_compile_options(kd_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
  $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion>
  $<$<AND:$<BOOL:${KD_WERROR}>,$<COMPILE_LANGUAGE:CXX>>:-Werror>)

# `fma` must be an instruction, not a library call: x86-64-v3 (2013 and later) has it, and the tools check for it when
# they start. Other architectures that matter have it in their baseline.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(kd_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-march=x86-64-v3>)
endif()

if(KD_SANITIZE)
  target_compile_options(kd_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=address,undefined;-fno-sanitize-recover=all;-fno-omit-frame-pointer>)
  target_link_options(kd_options INTERFACE -fsanitize=address,undefined)
endif()
