% Write it yourself: the report's gyroscope, started as the preset method-1.
% Runs as it is in Octave (octave mine.m) and in MATLAB, and writes mine.csv;
% but nothing moves yet: the physics, at "yours", is left out.
% gyrolab verify mine.csv --against method-1 says how far it is right.

steps = 1;                       % 1 first, then 10, then 2000
dt = 1e-3;                       % s
g = 9.8;                         % m/s^2
n = 10;                          % points of the rim, 2 pi/n apart from +x to +y
radius = 0.8;                    % m
hub = 0.565685424949238;         % m, height of the rim above the foot
m = 0.5;                         % kg, each of them
top = 1.131370849898476;         % m, height of the axle's top, which has no mass
L = [400; 0; 2000];              % J s, about the foot

% A column for each point, from the foot, m. Yours: the n points of the rim.
X = [0; 0; top];
mass = 0;

% Yours, for every-slip: turn the points and L about +x by the tilt.

file = fopen('mine.csv', 'w');
fprintf(file, 'step,t_s,x_m,y_m,z_m,Lx_Js,Ly_Js,Lz_Js\n');
for step = 0:steps
  if step > 0
    % Yours, in this order:
    % 1. I = sum of mass (|r|^2 E - r r'), over the columns r of X;
    %    E is the unit matrix, eye(3)
    % 2. Omega, from I Omega = L
    % 3. u = Omega/|Omega|, P = u u', angle = |Omega| dt
    % 4. R = P + cos(angle) (E - P) + sin(angle) [0 -u3 u2; u3 0 -u1; -u2 u1 0]
    % 5. each r becomes R r
    % 6. torque = sum of r x F, F = (0, 0, -mass g)
    % 7. L = L + dt torque
  end
  fprintf(file, '%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n', ...
          step, step * dt, X(1, 1), X(2, 1), X(3, 1), L(1), L(2), L(3));
end
fclose(file);
