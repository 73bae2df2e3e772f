// Atomic instructions of inline assembly. What the compiler does not announce, the assembler of ltsim-cc and ltsim-c++ does
// (program/announce-assembly.awk): it puts a call of one of these functions before such an instruction and one after it. The
// instruction itself is performed as it stands.
//
// The assembly says nothing of calls, so all registers stay as they are, flags and those of vectors included. Only x86-64.

#include <cstddef>

extern "C" {
// In atomics.cpp.
void ltsim_locked_instruction_follows(volatile void* address, std::size_t bytes, const void* caller);
void ltsim_locked_instruction_was_performed(bool success, const void* caller);
}

// xsave keeps x87, SSE, AVX and AVX-512: components 0xe7, 2688 bytes in its standard format, the header of 64 of them at 512.
asm(R"(
  .macro ltsim_keep_registers
    pushfq
    pushq %rbp
    movq %rsp, %rbp
    .irp register, rax, rcx, rdx, rsi, rdi, r8, r9, r10, r11
      pushq %\register
    .endr
    subq $2688, %rsp
    andq $-64, %rsp
    xorl %eax, %eax
    .irp offset, 512, 520, 528, 536, 544, 552, 560, 568
      movq %rax, \offset(%rsp)
    .endr
    movl $0xe7, %eax
    xorl %edx, %edx
    xsave (%rsp)
    cld
  .endm

  .macro ltsim_restore_registers_and_return
    movl $0xe7, %eax
    xorl %edx, %edx
    xrstor (%rsp)
    leaq -72(%rbp), %rsp
    .irp register, r11, r10, r9, r8, rdi, rsi, rdx, rcx, rax, rbp
      popq %\register
    .endr
    popfq
    ret
  .endm

  .text
  .irp bytes, 1, 2, 4, 8
    .globl ltsim_before_locked_\bytes
    .type ltsim_before_locked_\bytes, @function
    ltsim_before_locked_\bytes\():
      ltsim_keep_registers
      movl $\bytes, %esi
      movq 16(%rbp), %rdx
      call ltsim_locked_instruction_follows@PLT
      ltsim_restore_registers_and_return
  .endr

  .globl ltsim_after_locked
  .type ltsim_after_locked, @function
  ltsim_after_locked:
    ltsim_keep_registers
    movl $1, %edi
    movq 16(%rbp), %rsi
    call ltsim_locked_instruction_was_performed@PLT
    ltsim_restore_registers_and_return

  .globl ltsim_after_compare
  .type ltsim_after_compare, @function
  ltsim_after_compare:
    ltsim_keep_registers
    movl 8(%rbp), %edi
    shrl $6, %edi
    andl $1, %edi
    movq 16(%rbp), %rsi
    call ltsim_locked_instruction_was_performed@PLT
    ltsim_restore_registers_and_return
)");
