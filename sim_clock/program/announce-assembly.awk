# Announces to libltsim what inline assembly does atomically: the compiler's thread-sanitizer pass leaves assembly as it is. Reads what
# the compiler hands to the assembler (AT&T syntax) and writes it again; around each locked instruction between #APP and #NO_APP it puts
# a call before and one after it. What they keep, and what they make of it: takeover/inline_assembly.cpp.
#
# Announced are instructions with the prefix lock, and xchg, which is locked without it, of one to eight bytes. Left as they are: plain
# loads and stores, sixteen bytes, thread-local memory (%fs).

function trimmed(text) {
  gsub(/^[ \t]+|[ \t]+$/, "", text)
  return text
}

# The operands of an instruction, into operand[1], operand[2]...; a comma within parentheses parts nothing.
function split_operands(text, operand, count, depth, begin, i, letter) {
  count = 0
  depth = 0
  begin = 1
  for (i = 1; i <= length(text) + 1; ++i) {
    letter = substr(text, i, 1)
    if (letter == "(") ++depth
    if (letter == ")") --depth
    if (i > length(text) || (letter == "," && depth == 0)) {
      operand[++count] = trimmed(substr(text, begin, i - begin))
      begin = i + 1
    }
  }
  return count
}

function bytes_of_register(name) {
  if (name ~ /^%([abcd][lh]|[sd]il|[sb]pl|r[0-9]+b)$/) return 1
  if (name ~ /^%([abcd]x|[sd]i|[sb]p|r[0-9]+w)$/) return 2
  if (name ~ /^%(e..|r[0-9]+d)$/) return 4
  if (name ~ /^%r/) return 8
  return 0
}

function bytes_of_suffix(mnemonic) {
  if (mnemonic ~ /^cmpxchg(8b|16b)$/) return mnemonic ~ /16b/ ? 0 : 8
  if (mnemonic !~ /^(cmpxchg|xchg|xadd|add|adc|sub|sbb|and|or|xor|inc|dec|neg|not|bts|btr|btc)[bwlq]$/) return 0
  return mnemonic ~ /b$/ ? 1 : mnemonic ~ /w$/ ? 2 : mnemonic ~ /l$/ ? 4 : 8
}

function is_memory(operand) { return operand !~ /^[%$]/ && operand !~ /^%[fg]s:/ }

# One instruction without its prefix. @return whether it was written, with its announcements
function announced(instruction, prefix, mnemonic, operand, count, bytes, memory, i) {
  if (!match(instruction, /^[a-z0-9]+/)) return 0
  mnemonic = substr(instruction, 1, RLENGTH)
  if (prefix == "" && mnemonic !~ /^xchg[bwlq]?$/) return 0
  count = split_operands(substr(instruction, RLENGTH + 1), operand)
  bytes = bytes_of_suffix(mnemonic)
  memory = ""
  for (i = 1; i <= count; ++i) {
    if (is_memory(operand[i])) memory = operand[i]
    else if (bytes == 0 && mnemonic !~ /^cmpxchg16b$/) bytes = bytes_of_register(operand[i])
  }
  if (memory == "" || bytes == 0) return 0
  # Below the stack pointer the compiler may keep something: 128 bytes, by the x86-64 ABI.
  print "\tleaq\t-128(%rsp), %rsp"
  print "\tpushq\t%rdi"
  print "\tleaq\t" (memory ~ /\(%rsp/ ? "136+" memory : memory) ", %rdi"
  print "\tcall\tltsim_before_locked_" bytes "@PLT"
  print "\tpopq\t%rdi"
  print "\tleaq\t128(%rsp), %rsp"
  print "\t" prefix instruction
  print "\tleaq\t-128(%rsp), %rsp"
  print "\tcall\tltsim_after_" (mnemonic ~ /^cmpxchg/ ? "compare" : "locked") "@PLT"
  print "\tleaq\t128(%rsp), %rsp"
  return 1
}

/^[ \t]*#APP/ { is_inline = 1 }
/^[ \t]*#NO_APP/ { is_inline = 0 }
!is_inline || /^[ \t]*(#.*)?$/ { print; next }
/["\/]/ || (lock == "" && !/lock|xchg/) {
  print lock $0
  lock = ""
  next
}
{
  count = split($0, statements, ";")
  for (s = 1; s <= count; ++s) {
    statement = trimmed(statements[s])
    while (match(statement, /^[A-Za-z0-9_.$]+:/)) {
      print substr(statement, 1, RLENGTH)
      statement = trimmed(substr(statement, RLENGTH + 1))
    }
    if (statement == "") continue
    if (statement == "lock") {
      lock = "lock "
      continue
    }
    if (statement ~ /^lock[ \t]/) {
      lock = "lock "
      statement = trimmed(substr(statement, 5))
    }
    if (!announced(statement, lock)) print "\t" lock statement
    lock = ""
  }
}
