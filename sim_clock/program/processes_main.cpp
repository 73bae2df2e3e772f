// ltsim-processes: what "ltsim explore --process ..." becomes. All of it is in the library, in front of libc.

extern "C" int ltsim_run_processes(int count, char** arguments, char** environment);

int main(int count, char** arguments, char** environment) {
  return ltsim_run_processes(count, arguments, environment);
}
