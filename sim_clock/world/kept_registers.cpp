#include "sim_clock/world/kept_registers.hpp"

// In assembly, as a compiler may have changed a register before any statement of a function. The function that is called returns to
// who called this one.
asm(R"(
  .text
  .p2align 4
  .globl ltsim_keep_registers_and_call
  .type ltsim_keep_registers_and_call, @function
ltsim_keep_registers_and_call:
  .cfi_startproc
  endbr64
  movq %rsp, 0(%rdi)
  movq %rbx, 8(%rdi)
  movq %rbp, 16(%rdi)
  movq %r12, 24(%rdi)
  movq %r13, 32(%rdi)
  movq %r14, 40(%rdi)
  movq %r15, 48(%rdi)
  movq %rsi, %rax
  movq %rdx, %rdi
  jmpq *%rax
  .cfi_endproc
  .size ltsim_keep_registers_and_call, . - ltsim_keep_registers_and_call
)");
