# ltsim_instrument(target): compiles the target's sources so that the simulated world sees their memory accesses.
#
# The compiler's thread-sanitizer pass announces each access by a call. The target is NOT linked with that sanitizer's runtime: the
# world defines those calls itself. Copies stay calls: one that the compiler expands is over in one step, and could not be seen
# half done.
#
# Line tables say where in the sources the two accesses of a data race stand. A build with debug information has them anyway.
# Where an access stands is known by the return address of its call, so no call may be made into a jump.
#
# A project may ask everywhere for optimisation at link time. Not here: with gcc the pass would run only then, and linking does not
# ask for it.
#
# The package brings this file to other projects: it knows the compiler and the target, and nothing of this project.
function(ltsim_instrument target)
  set(no_debug_information "$<NOT:$<CONFIG:Debug,RelWithDebInfo>>")
  target_compile_options(${target} PRIVATE -fno-builtin-memcpy -fno-builtin-memmove -fno-builtin-memset
                                           -fno-optimize-sibling-calls -fno-lto)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(${target} PRIVATE $<${no_debug_information}:-gline-tables-only>)
    # clang's driver offers no flag for the pass alone; these are LLVM's.
    target_compile_options(${target} PRIVATE -fsanitize=thread "SHELL:-mllvm -tsan-distinguish-volatile=1"
                                             "SHELL:-mllvm -tsan-instrument-func-entry-exit=0")
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc warns of fences because its own runtime does not follow them; the world does.
    target_compile_options(${target} PRIVATE $<${no_debug_information}:-g1> -Wno-tsan)
    target_compile_options(${target} PRIVATE -fsanitize=thread "SHELL:--param tsan-distinguish-volatile=1"
                                             "SHELL:--param tsan-instrument-func-entry-exit=0")
  else()
    message(FATAL_ERROR "ltsim_instrument(${target}): with gcc or clang only, not with ${CMAKE_CXX_COMPILER_ID}")
  endif()
endfunction()
