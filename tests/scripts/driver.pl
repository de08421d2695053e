#!/usr/bin/perl
# The smallest driver: a robot whose head turns. docs/script-protocol.md describes what it does.
use strict;
use warnings;

$| = 1;
my $folder = shift;

# Writes reply.bin: named arrays, each a name, a class, rows, columns and the bytes of its elements.
sub reply {
    my ($records, $names, $elements) = ('', '', '');
    for (@_) {
        my ($name, $class, $rows, $columns, $bytes) = @$_;
        $records .= pack 'V12', $class, length $name, length $bytes, 2, $rows, $columns, (0) x 6;
        $names .= $name;
        $elements .= $bytes . "\0" x (-length($bytes) % 8);
    }
    my $start = 'TTA1' . pack('V3', 1, scalar @_, length $names) . $records . $names;
    open my $file, '>:raw', "$folder/reply.bin" or die $!;
    print $file $start, "\0" x (-length($start) % 8), $elements;
    close $file;
}

while (<STDIN>) {
    my ($request, $number) = split;
    reply(['engine', 2, 1, 4, 'Perl']) if $request eq 'hello';
    reply() if $request eq 'init';
    reply(['motor.headVelocity', 0, 1, 1, pack 'd<', 0.5]) if $request eq 'step';
    print "\x01done $number\n";
}
