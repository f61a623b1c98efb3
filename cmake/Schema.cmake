# kd_schema(TARGET SCHEMA [flatc arguments]): C++ generated from a FlatBuffers schema, as headers of a library TARGET.
function(kd_schema target schema)
  get_filename_component(name ${schema} NAME_WE)
  set(directory ${PROJECT_BINARY_DIR}/generated/${name})
  set(headers ${directory}/${name}_generated.h)
  if("--bfbs-gen-embed" IN_LIST ARGN)
    list(APPEND headers ${directory}/${name}_bfbs_generated.h)
  endif()
  add_custom_command(
    OUTPUT ${headers}
    COMMAND ${KD_FLATC} --cpp --scoped-enums ${ARGN} -o ${directory} ${schema}
    DEPENDS ${schema}
    COMMENT "Generating ${name}_generated.h")
  add_custom_target(${target}_header DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_header)
  target_include_directories(${target} SYSTEM INTERFACE ${directory})
endfunction()
