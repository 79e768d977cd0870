#!/usr/bin/perl
# An engine for Rigor in Perl, written from the guide in adapters/README.md alone: free bodies that fixed ones do not
# touch, by semi-implicit Euler; the angular momentum is kept in the world frame, and a turn takes the angular velocity at
# its middle. The loads come from Rigor, as wrenches.
use strict;
use warnings;
use JSON::PP;

$| = 1;
my %worlds;

sub cross { my ($a, $b) = @_; map { my ($m, $n) = (($_ + 1) % 3, ($_ + 2) % 3); $a->[$m] * $b->[$n] - $a->[$n] * $b->[$m] } 0 .. 2 }
sub turned {    # a by the quaternion q; back where $sign is -1
  my ($q, $a, $sign) = @_;
  my @u = map { $sign * $q->[$_] } 1 .. 3;
  my @t = map { 2 * $_ } cross(\@u, $a);
  my @c = cross(\@u, \@t);
  return [map { $a->[$_] + $q->[0] * $t[$_] + $c[$_] } 0 .. 2];
}
sub product { my ($M, $a) = @_; [map { my $row = $_; $M->[$row][0] * $a->[0] + $M->[$row][1] * $a->[1] + $M->[$row][2] * $a->[2] } 0 .. 2] }
sub in_world { my ($M, $q, $a) = @_; turned($q, product($M, turned($q, $a, -1)), 1) }
sub inverse {
  my ($I) = @_;
  my @m;
  for my $r (0 .. 2) {
    for my $c (0 .. 2) {
      my ($r1, $r2, $c1, $c2) = (($r + 1) % 3, ($r + 2) % 3, ($c + 1) % 3, ($c + 2) % 3);
      $m[$c][$r] = $I->[$r1][$c1] * $I->[$r2][$c2] - $I->[$r1][$c2] * $I->[$r2][$c1];
    }
  }
  my $det = $I->[0][0] * $m[0][0] + $I->[0][1] * $m[1][0] + $I->[0][2] * $m[2][0];
  return [map { [map { $det ? $_ / $det : 0 } @$_] } @m];
}
sub spun {    # the quaternion q, turned by dt w
  my ($q, $w, $dt) = @_;
  my $rate = sqrt($w->[0]**2 + $w->[1]**2 + $w->[2]**2);
  my $half = 0.5 * $dt * $rate;
  my $s = $half > 1e-8 ? sin($half) / $rate : 0.5 * $dt;
  my ($e, @v) = (cos($half), map { $s * $_ } @$w);
  my @u = @$q[1 .. 3];
  my @c = cross(\@v, \@u);
  my @r = ($e * $q->[0] - $v[0] * $u[0] - $v[1] * $u[1] - $v[2] * $u[2], map { $e * $u[$_] + $q->[0] * $v[$_] + $c[$_] } 0 .. 2);
  my $size = sqrt($r[0]**2 + $r[1]**2 + $r[2]**2 + $r[3]**2);
  return [map { $_ / $size } @r];
}

sub body_of {
  my ($said) = @_;
  my %body = (mass => $said->{mass} // 0, fixed => $said->{fixed}, x => $said->{position}, q => $said->{orientation_wxyz} // [1, 0, 0, 0],
    v => $said->{velocity} // [0, 0, 0], w => $said->{angular_velocity} // [0, 0, 0]);
  my ($xx, $yy, $zz, $xy, $xz, $yz) = (@{$said->{inertia} // [0, 0, 0]}, 0, 0, 0);
  $body{I} = [[$xx, $xy, $xz], [$xy, $yy, $yz], [$xz, $yz, $zz]];
  $body{J} = inverse($body{I});
  return \%body;
}
sub move {
  my ($b, $g, $dt, $load) = @_;
  $b->{v} = [map { $b->{v}[$_] + $dt * ($g->[$_] + $load->[$_] / $b->{mass}) } 0 .. 2];
  $b->{x} = [map { $b->{x}[$_] + $dt * $b->{v}[$_] } 0 .. 2];
  my $L = in_world($b->{I}, $b->{q}, $b->{w});
  $L = [map { $L->[$_] + $dt * $load->[3 + $_] } 0 .. 2];
  my $middle = spun($b->{q}, in_world($b->{J}, $b->{q}, $L), $dt / 2);
  $b->{q} = spun($b->{q}, in_world($b->{J}, $middle, $L), $dt);
  $b->{w} = in_world($b->{J}, $b->{q}, $L);
}

my %answers = (
  info => sub { {name => "perl", version => "1", precision => "double", features => ["wrench", "fixed-body"],
      methods => [{name => "euler", summary => "semi-implicit Euler", order => 1, leapfrog_stagger => 0.5}]} },
  load => sub {
    my ($asked) = @_;
    my $scene = $asked->{scene};
    $worlds{$asked->{world}} = {time => 0, gravity => $scene->{gravity}, bodies => [map { body_of($_) } @{$scene->{body}}]};
    return {settings => {gyroscopic => "on"}};
  },
  step => sub {
    my ($asked) = @_;
    my $world = $worlds{$asked->{world}};
    for my $i (0 .. $#{$world->{bodies}}) {
      my $body = $world->{bodies}[$i];
      move($body, $world->{gravity}, $asked->{dt}, $asked->{wrenches} ? $asked->{wrenches}[$i] : [(0) x 6]) unless $body->{fixed};
    }
    $world->{time} += $asked->{dt};
    return {};
  },
  read => sub {
    my $world = $worlds{$_[0]{world}};
    my @rows = map { my $b = $_; [map { 0 + sprintf("%.17g", $_) } @{$b->{x}}, @{$b->{q}}, @{$b->{v}}, @{$b->{w}}] } @{$world->{bodies}};
    return {ok => JSON::PP::false, status => "diverged", why => "a number is not finite"} if grep { !/^[-+.0-9e]+$/ } map { @$_ } @rows;
    return {time => $world->{time}, bodies => \@rows};
  },
  unload => sub { delete $worlds{$_[0]{world}}; return {} },
);

my $json = JSON::PP->new->canonical;
while (my $line = <STDIN>) {
  my $asked = $json->decode($line);
  my $answer = $answers{$asked->{call}};
  print $json->encode($answer ? {ok => JSON::PP::true, %{$answer->($asked)}} : {ok => JSON::PP::false, status => "unsupported", why => "no such call"}), "\n";
}
