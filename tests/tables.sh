#!/bin/sh
# Whether two builds compute the same tables, to the last digit, times left out.
#   sh tests/tables.sh run BUILD OUT [STUDY...]   runs studies (default: all that ship but the eight longest) by BUILD/bin/ricochet into OUT
#   sh tests/tables.sh compare A B                what two such folders have differently; exit code 1 where they do
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)

run() {
  build=$1 out=$2
  shift 2
  mkdir -p "$out"
  if [ $# -eq 0 ]; then
    for study in "$root"/studies/*.json; do
      case $(basename "$study" .json) in
        basins | basins-million | coexistence | bifurcation-beta | bifurcation-mass | bifurcation-penalty | bifurcation-reference | bifurcation-reference-tip) ;;
        *) set -- "$@" "$study" ;;
      esac
    done
  fi
  for study in "$@"; do
    name=$(basename "$study" .json) status=0
    "$build/bin/ricochet" run "$study" --out "$out/$name" > "$out/$name.log" 2>&1 || status=$?
    echo "$name: exit code $status"
  done
}

# Perl is part of every Debian.
compare() {
  perl - "$1" "$2" <<'PERL'
use strict;
use warnings;
my ($first, $second) = @ARGV;
my $differs = 0;

# Rows of a CSV file (RFC 4180), cells by name, without times and what follows from them.
sub table {
  my ($file) = @_;
  open(my $in, '<', $file) or die "$file: $!\n";
  local $/;
  my $text = <$in>;
  my (@rows, @row);
  while ($text =~ /\G(?:"((?:[^"]|"")*)"|([^,\n]*))(,|\n|\z)/g) {
    my $cell = defined $1 ? $1 : $2;
    push @row, $cell;
    next if $3 eq ',';
    push @rows, [@row] unless @row == 1 && $row[0] eq '';
    @row = ();
    last if $3 eq '';
  }
  my $head = shift @rows || [];
  my @keep = grep { $head->[$_] !~ /second|^timed_/ } 0 .. $#$head;
  @keep = grep { $head->[$_] !~ /^(low|high)$/ } @keep if $file =~ /work_precision\.csv$/;
  return map { join("\t", map { defined $_ ? $_ : '' } @$_[@keep]) } $head, @rows;
}

sub names { my ($folder) = @_; return map { s/^\Q$folder\E\///r } glob("$folder/*/*.csv"), glob("$folder/*/curves/*.csv") }
my %in = map { $_ => 1 } names($first);
my %both = (%in, map { $_ => 1 } names($second));
for my $name (sort keys %both) {
  # Of costs: which method is the cheapest is another thing at each run.
  next if $name =~ /^work-precision[^\/]*\/(answers|effects|effects_said|work_precision_\w+|precision\w*|work_\w+)\.csv$/ || $name =~ /environment/;
  my ($a, $b) = ("$first/$name", "$second/$name");
  if (!-e $a || !-e $b) { print "$name: only in ", (-e $a ? $first : $second), "\n"; $differs = 1; next }
  my @a = table($a);
  my @b = table($b);
  my $most = @a > @b ? @a : @b;
  my @rows = grep { ($a[$_] // '') ne ($b[$_] // '') } 0 .. $most - 1;
  next unless @rows;
  $differs = 1;
  printf "%s: %d of %d rows\n", $name, scalar @rows, $most - 1;
  for my $k (@rows[0 .. ($#rows < 1 ? $#rows : 1)]) {
    print "  - ", substr($a[$k] // '(no row)', 0, 300), "\n  + ", substr($b[$k] // '(no row)', 0, 300), "\n";
  }
}
exit $differs;
PERL
}

case ${1:-} in
  run) [ $# -ge 3 ] || { sed -n '2,4p' "$0" >&2; exit 2; }; shift; run "$@" ;;
  compare) [ $# -eq 3 ] || { sed -n '2,4p' "$0" >&2; exit 2; }; compare "$2" "$3" ;;
  *) sed -n '2,4p' "$0" >&2; exit 2 ;;
esac
