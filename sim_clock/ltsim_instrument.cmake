# ltsim_instrument(target): compiles the target's sources so that the simulated world sees their memory accesses.
#
# The compiler's thread-sanitizer pass announces each access by a call. The target is NOT linked with that sanitizer's runtime: the
# world defines those calls itself. Copies stay calls: one that the compiler expands is over in one step, and could not be seen
# half done.
function(ltsim_instrument target)
  target_compile_options(${target} PRIVATE -fno-builtin-memcpy -fno-builtin-memmove -fno-builtin-memset)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # clang's driver offers no flag for the pass alone; these are LLVM's.
    target_compile_options(${target} PRIVATE -fsanitize=thread "SHELL:-mllvm -tsan-distinguish-volatile=1"
                                             "SHELL:-mllvm -tsan-instrument-func-entry-exit=0")
  else()
    target_compile_options(${target} PRIVATE -fsanitize=thread "SHELL:--param tsan-distinguish-volatile=1"
                                             "SHELL:--param tsan-instrument-func-entry-exit=0")
  endif()
endfunction()

# ltsim_instrumented_twin(protocol): library ltsim::protocol_instrumented from the very sources of ltsim::protocol. What the
# original links of the libraries that have a twin, the twin links as their twins.
function(ltsim_instrumented_twin name)
  get_target_property(sources ltsim_${name} SOURCES)
  get_target_property(folder ltsim_${name} SOURCE_DIR)
  get_target_property(links ltsim_${name} INTERFACE_LINK_LIBRARIES)
  list(TRANSFORM sources PREPEND ${folder}/)
  add_library(ltsim_${name}_instrumented STATIC ${sources})
  add_library(ltsim::${name}_instrumented ALIAS ltsim_${name}_instrumented)
  target_include_directories(ltsim_${name}_instrumented PUBLIC ${PROJECT_SOURCE_DIR})
  foreach(link IN LISTS links)
    if(TARGET ${link}_instrumented)
      target_link_libraries(ltsim_${name}_instrumented PUBLIC ${link}_instrumented)
    elseif(NOT link MATCHES "LINK_ONLY")
      target_link_libraries(ltsim_${name}_instrumented PUBLIC ${link})
    endif()
  endforeach()
  target_link_libraries(ltsim_${name}_instrumented PRIVATE ltsim_options)
  ltsim_instrument(ltsim_${name}_instrumented)
endfunction()
